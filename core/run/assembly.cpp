#include "run/assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>

#include "component/joint_answer.h"
#include "linear/row_solutions.h"
#include "run/force_turns.h"
#include "run/gear_turns.h"
#include "run/leg_modes.h"
#include "run/newton_stage_solver.h"
#include "run/placing.h"
#include "run/start_rows.h"
#include "system/path_follower.h"

namespace freeplay {
namespace {

using Eigen::VectorXd;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

[[noreturn]] void throw_fault(const Model& model, const Fault& fault) {
  if (fault.kind == Fault::Kind::motion) throw_motion_fault(model, fault.motion, Error::Category::input);
  const JointElement& joint = model.joints[at(fault.joint)];
  if (fault.of_expression()) {
    throw Error(Error::Category::input, fault.message.id, fmt::format("joint '{}': {}", joint.name, fault.message.text),
                joint.location);
  }
  throw Error(Error::Category::plugin, "plugin-failed",
              fmt::format("joint '{}' of {} failed while the model was assembled: {}", joint.name,
                          model.instances.words_of(*joint.component), fault.message.text),
              joint.location);
}

// The closed mechanism at the start time and the rows that hold it there.
class Assembler {
 public:
  Assembler(System& system, const OffsetChange& change)
      : system_(system),
        change_(change),
        model_(system.model()),
        closed_(system.model(), Variant::closed),
        state_(closed_.layout(), 0),
        e_(prepare()) {}

  Start run() {
    choose_held_coordinates();
    place_bodies(closed_, held_, state_.q());
    remember_turns();
    if (std::ranges::any_of(followed_, [](char yes) { return yes != 0; })) follow_paths();
    set_offsets({});
    solve_positions();
    check_paths();
    solve_velocities();
    if (load_journals()) {
      solve_positions();
      solve_velocities();
    }
    return release();
  }

 private:
  Evaluation prepare() {
    closed_.share_motions(system_);
    state_.t() = model_.settings.start;
    return Evaluation(closed_);
  }

  void evaluate(unsigned terms) {
    if (!closed_.evaluate(point(state_), terms | term_coordinate, e_)) throw_fault(model_, e_.fault);
    if (!gear_turns_ || !gear_turns_->recount(e_.coordinate, state_.h())) return;
    if (!closed_.evaluate(point(state_), terms | term_coordinate, e_)) throw_fault(model_, e_.fault);
  }

  // Values that joints lead or are driven to at the start. A driver of a speed starts where `initial` says.
  void choose_held_coordinates() {
    held_.assign(model_.joints.size(), nan);
    leads_.clear();
    held_row_.assign(at(closed_.layout().nc()), 1);
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      if (model_.joints[j].start_coordinate) held_[j] = model_.joints[j].start_coordinate->value;
    }
    std::vector<char> driven(model_.joints.size(), 0);
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (driver.kind != DriverKind::velocity) continue;
      driven[at(driver.joint)] = 1;
      if (const auto& start = model_.joints[at(driver.joint)].start_coordinate) {
        system_.motions().set_start(d, start->value);
      } else {
        held_row_[at(closed_.layout().driver_row(d))] = 0;
      }
    }
    std::vector<TimeValue> motion(model_.drivers.size());
    MotionFault fault;
    if (!system_.motions().evaluate(state_.t(), {motion.data(), motion.size()}, fault)) {
      throw_motion_fault(model_, fault, Error::Category::input);
    }
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (!prescribes(driver.kind) || driver.kind == DriverKind::velocity) continue;
      driven[at(driver.joint)] = 1;
      if (closed_.motions().follows(d)) continue;
      held_[at(driver.joint)] = motion[at(d)].value;
    }
    for (const Gear& gear : model_.gears) {
      if (!gear.offset) held_row_[at(closed_.layout().rows(gear.joint).offset)] = 0;
    }
    for (int k = 0; k < static_cast<int>(model_.kinematics.size()); ++k) {
      followed_.push_back(closed_.motions().entry_follows(k) ? 1 : 0);
    }
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (model_.joints[at(j)].start_coordinate && !driven[at(j)]) leads_.push_back(j);
    }
  }

  // Angles are counted from the value that a joint leads or is driven to, else as a gear says, else from (-pi, pi].
  void remember_turns() {
    count_gears(false);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const int turn = closed_.layout().turn(j);
      if (turn >= 0) state_.h()[at(turn)] = std::isnan(held_[at(j)]) ? 0.0 : held_[at(j)];
    }
  }

  void count_gears(bool from_slides) {
    std::vector<bool> counted;
    for (const double held : held_) counted.push_back(!std::isnan(held));
    gear_turns_.emplace(model_, closed_.layout(), std::move(counted), from_slides);
  }

  // Driven joints without a closed form: the ideal mechanism stands on the paths, which tells where the joints are now
  // and, followed from here, at any time.
  void follow_paths() {
    hold_followed_drivers(false);
    solve_positions();
    bool bent = false;
    for (std::size_t k = 0; k < followed_.size(); ++k) {
      if (followed_[k]) bent = bend_legs(model_, model_.kinematics[k], state_.q()) || bent;
    }
    if (bent) solve_positions();
    check_paths();
    system_.motions().follow(std::make_shared<const PathFollower>(closed_, state_.q(), state_.h()));
    hold_followed_drivers(true);
    e_.forget_motions();
  }

  // Either the drivers of these entries hold the mechanism, or the paths do.
  void hold_followed_drivers(bool drivers) {
    paths_.clear();
    for (int k = 0; k < static_cast<int>(model_.kinematics.size()); ++k) {
      if (!followed_[at(k)]) continue;
      const InverseKinematics& entry = model_.kinematics[at(k)];
      for (int d = 0; d < entry.driver_count; ++d) {
        held_row_[at(closed_.layout().driver_row(entry.first_driver + d))] = drivers ? 1 : 0;
      }
      const std::vector<PathRow> rows = path_rows(model_, k);
      if (!drivers) paths_.insert(paths_.end(), rows.begin(), rows.end());
    }
  }

  // Starts of the joints with play; `reactions` hold a force for each joint, or nothing yet.
  bool set_offsets(const std::vector<std::array<double, 3>>& reactions) {
    bool moved = false;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (!joint.has_play) continue;
      std::array<double, 3> force = reactions.empty() ? std::array<double, 3>{} : reactions[at(j)];
      InitialOffset offset{};
      Message message;
      if (!reactions.empty()) offset.rotation = e_.markers[at(joint.marker_a)].rotation;
      if (!joint.joint.initial_offset({force.data(), force.size()}, offset, message)) {
        throw Error(Error::Category::input, "assembly-failed",
                    fmt::format("joint '{}' has no start: {}", joint.name, message.text), joint.location);
      }
      offset.rotation = nullptr;
      if (change_) change_(j, offset);
      moved = moved || !reactions.empty();
      closed_.set_offset(j, offset);
    }
    return moved;
  }

  struct Rows {
    SparseMatrix matrix;
    VectorXd residual;
    std::vector<int> row;   // of the closed system, -1 for a leading joint or a path
    std::vector<int> lead;  // joint that leads, -1
    std::vector<int> path;  // index into paths_, -1
    void add(int of_system, int of_lead, int of_path) {
      row.push_back(of_system);
      lead.push_back(of_lead);
      path.push_back(of_path);
    }
  };

  double path_value(const PathRow& path) const {
    PathPose pose;
    MotionFault fault;
    if (!closed_.motions().path(path.kinematics, state_.t(), pose, fault)) {
      throw_motion_fault(model_, fault, Error::Category::input);
    }
    return pose[at(path.component)].value;
  }

  // Rows of the closed mechanism and its drivers, then those of leading joints and paths. Speeds: Phi_q v - nu.
  Rows rows(bool speeds) {
    evaluate(term_position | term_velocity);
    const int nc = closed_.layout().nc(), nv = closed_.layout().nv();
    VectorXd flow(nc);
    closed_.multiply(e_, state_.v(), {flow.data(), at(nc)});
    Rows out;
    std::vector<int> leads;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (speeds ? joint.start_speed.has_value() : std::ranges::count(leads_, j) > 0) leads.push_back(j);
    }
    for (int r = 0; r < nc; ++r) {
      if (speeds || held_row_[at(r)]) out.add(r, -1, -1);
    }
    for (const int j : leads) out.add(-1, j, -1);
    for (std::size_t p = 0; p < paths_.size(); ++p) out.add(-1, -1, static_cast<int>(p));
    const auto count = static_cast<Eigen::Index>(out.row.size());
    std::vector<SparseEntry> system_entries, entries;
    closed_.jacobian_entries(e_, system_entries);
    std::vector<int> place(at(nc), -1);
    out.residual = VectorXd::Zero(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int r = out.row[static_cast<std::size_t>(i)], j = out.lead[static_cast<std::size_t>(i)];
      if (r >= 0) {
        place[at(r)] = static_cast<int>(i);
        out.residual[i] = speeds ? flow[r] - e_.nu[at(r)] : e_.phi[at(r)];
        continue;
      }
      if (const int p = out.path[static_cast<std::size_t>(i)]; p >= 0) {
        const PathRow& path = paths_[at(p)];
        double row[3];
        path.entries(e_, row);
        for (int c = 0; c < 3 && path.body != ground; ++c) entries.emplace_back(i, 3 * path.body + c, row[c]);
        out.residual[i] = path.residual(closed_, point(state_), e_, path_value(path));
        continue;
      }
      double row[12], bias = 0.0;
      closed_.coordinate_row(j, e_, row, bias);
      const int width = closed_.body_velocities();
      const JointElement& joint = model_.joints[at(j)];
      const int bodies[2] = {model_.markers[at(joint.marker_a)].body, model_.markers[at(joint.marker_b)].body};
      for (int k = 0; k < 2; ++k) {
        for (int c = 0; c < width && bodies[k] != ground; ++c) {
          entries.emplace_back(i, width * bodies[k] + c, row[width * k + c]);
        }
      }
      out.residual[i] = speeds ? e_.coordinate_rate[at(j)] - joint.start_speed->value
                               : e_.coordinate[at(j)] - joint.start_coordinate->value;
    }
    for (const SparseEntry& entry : system_entries) {
      if (const int i = place[at(entry.row())]; i >= 0) entries.emplace_back(i, entry.col(), entry.value());
    }
    out.matrix = sparse_matrix(count, nv, entries);
    return out;
  }

  static double largest(const VectorXd& residual) {
    return residual.size() == 0 ? 0.0 : residual.lpNorm<Eigen::Infinity>();
  }

  // Newton with corrections of least norm in m and rad, shortened where the residual would grow.
  Rows converge() {
    const double tolerance = model_.settings.assembly_tolerance;
    Rows now = rows(false);
    for (int iteration = 0; iteration < model_.settings.assembly_iterations; ++iteration) {
      const double before = now.residual.norm();
      if (before == 0.0) break;
      const VectorXd step = least_norm_solution(now.matrix, -now.residual);
      const std::vector<double> q(state_.q().begin(), state_.q().end());
      double length = 1.0, after = before;
      for (int halving = 0; halving < 12; ++halving, length *= 0.5) {
        const VectorXd increment = length * step;
        closed_.retract(q, {increment.data(), at(static_cast<int>(increment.size()))}, state_.q());
        now = rows(false);
        after = now.residual.norm();
        if (after < before) break;
      }
      if (!(after < before)) {
        std::ranges::copy(q, state_.q().begin());
        now = rows(false);
        break;
      }
      // Past the tolerance go on while it pays: later steps start from rounding, not from here.
      if (largest(now.residual) <= 1e-3 * tolerance && after > 0.1 * before) break;
    }
    return now;
  }

  // A rack that other joints put far away has turned its pinion more than half a turn.
  bool converge_from_slides(const std::vector<double>& guess) {
    const auto fixed = [](const Gear& gear) { return gear.offset.has_value(); };
    if (std::ranges::none_of(model_.gears, fixed)) return false;
    count_gears(true);
    std::ranges::copy(guess, state_.q().begin());
    if (holds(converge())) return true;
    count_gears(false);
    return false;
  }

  bool holds(const Rows& now) const { return largest(now.residual) <= model_.settings.assembly_tolerance; }

  // Newton cannot leave a guess with all links in one line, where no small turn changes the gap at first order: files
  // that give no pose begin so. Then the bodies are turned a little, each by another fixed angle.
  bool converge_from_turned(const std::vector<double>& guess) {
    for (const double turn : {0.1, 0.5, 1.5}) {
      std::ranges::copy(guess, state_.q().begin());
      std::vector<double> increment(state_.v().size(), 0.0);
      for (int i = 0, turned = 0; i < static_cast<int>(increment.size()); ++i) {
        if (!closed_.is_turn(i)) continue;
        const double share = static_cast<double>(++turned) * 0.6180339887498949;  // golden ratio: spread evenly
        increment[at(i)] = turn * (2.0 * (share - std::floor(share)) - 1.0);
      }
      closed_.retract(guess, increment, state_.q());
      if (holds(converge())) return true;
    }
    return false;
  }

  void solve_positions() {
    const std::vector<double> guess(state_.q().begin(), state_.q().end());
    Rows now = converge();
    if (!holds(now)) {
      const std::vector<double> nearest(state_.q().begin(), state_.q().end());
      if (!converge_from_slides(guess) && !converge_from_turned(guess)) {
        std::ranges::copy(nearest, state_.q().begin());
        if (!paths_.empty()) check_paths();
        report_gap(rows(false));
      }
    }
    keep_gear_offsets();
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (driver.kind == DriverKind::velocity && !model_.joints[at(driver.joint)].start_coordinate) {
        system_.motions().set_start(d, e_.coordinate[at(driver.joint)]);
        e_.forget_motions();
      }
    }
  }

  // A gear without an offset of its own keeps the one that it finds.
  void keep_gear_offsets() {
    for (int g = 0; g < static_cast<int>(model_.gears.size()); ++g) {
      const Gear& gear = model_.gears[at(g)];
      if (gear.offset) continue;
      const double offset = e_.coordinate[at(gear.second)] - gear.ratio * e_.coordinate[at(gear.first)];
      closed_.set_gear_offset(g, offset);
      system_.set_gear_offset(g, offset);
    }
  }

  double worst_allowed() const { return model_.settings.assembly_tolerance; }

  [[noreturn]] void report_gap(const Rows& rows) const {
    double worst = -1.0;
    std::string text;
    Location location;
    const auto consider = [&](double gap, const std::string& words, const Location& place) {
      if (!(gap <= worst)) worst = gap, text = words, location = place;
    };
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const Slice slice = closed_.layout().rows(j);
      if (slice.size > 0 && !held_row_[at(slice.offset)]) continue;
      double gap = 0.0;
      for (int r = 0; r < slice.size; ++r) gap = std::hypot(gap, e_.phi[at(slice.offset + r)]);
      consider(gap, fmt::format("joint '{}' stays open by {:.6g} m", model_.joints[at(j)].name, gap),
               model_.joints[at(j)].location);
    }
    for (std::size_t i = 0; i < rows.row.size(); ++i) {
      if (rows.path[i] < 0 || std::abs(rows.residual[static_cast<Eigen::Index>(i)]) <= worst_allowed()) continue;
      const InverseKinematics& entry = model_.kinematics[at(paths_[at(rows.path[i])].kinematics)];
      throw Error(Error::Category::input, "ik-unreachable",
                  fmt::format("the mechanism cannot bring the frame of '{}' to its path at the start time {} s",
                              entry.name, state_.t()),
                  entry.path_location, "if it can, give the bodies a `pose` closer to the wanted one");
    }
    for (std::size_t i = 0; i < rows.row.size(); ++i) {
      const double gap = std::abs(rows.residual[static_cast<Eigen::Index>(i)]);
      if (rows.lead[i] >= 0) {
        const JointElement& joint = model_.joints[at(rows.lead[i])];
        consider(gap, fmt::format("joint '{}' misses its start value by {:.6g}", joint.name, gap), joint.location);
      }
    }
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const int r = closed_.layout().driver_row(d);
      if (r < 0 || !held_row_[at(r)]) continue;
      const double gap = std::abs(e_.phi[at(r)]);
      consider(gap, fmt::format("driver '{}' misses its value by {:.6g}", model_.drivers[at(d)].name, gap),
               model_.drivers[at(d)].location);
    }
    throw Error(Error::Category::input, "assembly-failed", "the mechanism cannot be put together: " + text, location,
                "check lengths and start values, or give the bodies a `pose` closer to the wanted one");
  }

  void check_paths() {
    evaluate(term_position | term_velocity);
    freeplay::check_paths(closed_, e_);
  }

  // Least change of the given velocities in kinetic energy; in m and rad where the mass says nothing.
  void solve_velocities() {
    start_velocities(closed_, state_.q(), state_.v());
    const int nv = closed_.layout().nv();
    const Eigen::Map<const VectorXd> mass(system_.mass().data(), nv);
    // Repeated because the rate of a coordinate is linear in v only to rounding.
    for (int pass = 0; pass < 3; ++pass) {
      const Rows now = rows(true);
      if (now.row.empty()) return;
      const VectorXd change = pass == 0 ? least_weighted_solution(now.matrix, mass, -now.residual)
                                        : least_norm_solution(now.matrix, -now.residual);
      for (int i = 0; i < nv; ++i) state_.v()[at(i)] += change[i];
    }
    const Rows last = rows(true);
    const double tolerance = 1e-8 * std::max(1.0, Eigen::Map<const VectorXd>(state_.v().data(), nv).norm());
    if (largest(last.residual) > tolerance) report_contradiction(last, tolerance);
  }

  // Least squares share a contradiction among all rows that take part; what was asked for is told before joints.
  [[noreturn]] void report_contradiction(const Rows& rows, double tolerance) const {
    Origin worst;
    double gap = 0.0;
    for (std::size_t i = 0; i < rows.row.size(); ++i) {
      const double missed = std::abs(rows.residual[static_cast<Eigen::Index>(i)]);
      if (missed <= tolerance) continue;
      Origin origin = origin_of(rows.row[i], rows.lead[i]);
      if (origin.asked < worst.asked || (origin.asked == worst.asked && missed <= gap)) continue;
      gap = missed;
      worst = std::move(origin);
    }
    throw Error(
        Error::Category::input, "assembly-failed",
        fmt::format("drivers and start speeds contradict each other: {} misses its speed by {:.6g}", worst.words, gap),
        worst.location);
  }

  // What a row stands for, and how directly the file asks for it: a start speed 2, a driver 1, a joint 0.
  struct Origin {
    int asked = -1;
    std::string words{};
    Location location{};
  };

  Origin origin_of(int row, int lead) const {
    if (lead >= 0) {
      const JointElement& joint = model_.joints[at(lead)];
      return {2, fmt::format("joint '{}'", joint.name), joint.start_speed->location};
    }
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (closed_.layout().driver_row(d) == row) {
        return {1, fmt::format("driver '{}'", driver.name), driver.location};
      }
    }
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const Slice slice = closed_.layout().rows(j);
      if (row < slice.offset || row >= slice.offset + slice.size) continue;
      return {0, fmt::format("joint '{}'", model_.joints[at(j)].name), model_.joints[at(j)].location};
    }
    return {0, "a constraint"};
  }

  // Journals that rest in their bearings need the reactions of the ideal mechanism.
  bool load_journals() {
    if (model_.clearance_joints() == 0) return false;
    NewtonStageSolver solver(closed_, {});
    solver.use_history(state_.h());
    StateView view = state_.view();
    if (!solver.accelerate(view, view.z)) return false;  // the released mechanism decides
    evaluate(term_position | term_velocity | term_force);
    std::vector<std::array<double, 3>> reactions(model_.joints.size());
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      double wrench[6];
      closed_.reaction(j, e_, state_.lambda(), wrench);
      reactions[at(j)] = {wrench[0], wrench[1], wrench[2]};
    }
    return set_offsets(reactions);
  }

  Start release() {
    ConstraintFacts ideal;
    if (model_.clearance_joints() > 0) ideal = facts_of(closed_);
    evaluate(term_position | term_velocity);
    Start start{State(system_.layout(), 0), count_facts(model_), {}};
    State& state = start.state;
    state.t() = state_.t();
    std::ranges::copy(state_.q(), state.q().begin());
    std::ranges::copy(state_.v(), state.v().begin());
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      if (const int turn = system_.layout().turn(j); turn >= 0) {
        state.h()[at(turn)] = start_angle(model_, e_.coordinate, j);
      }
    }
    initialize_joints(state);
    Evaluation released(system_);
    if (!system_.evaluate(point(state), term_position | term_velocity, released)) throw_fault(model_, released.fault);
    refuse_massless_motion(system_, released);
    NewtonStageSolver solver(system_, {});
    solver.use_history(state.h());
    StateView view = state.view();
    std::vector<double> z_rate(state.z().size());
    if (!solver.accelerate(view, {z_rate.data(), z_rate.size()})) {
      if (solver.fault().kind != Fault::Kind::none) throw_fault(model_, solver.fault());
      throw Error(Error::Category::input, "singular-mass", solver.trouble());
    }
    start.facts.actual = facts_of(system_);
    if (model_.clearance_joints() > 0) start.facts.ideal = ideal;
    start.structure = examine_structure(system_, released, closed_, e_);
    return start;
  }

  void initialize_joints(State& state) {
    Evaluation e(system_);
    if (!system_.evaluate(point(state), term_coordinate, e)) throw_fault(model_, e.fault);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const Slice z = system_.layout().internal(j), h = system_.layout().history(j);
      Message message;
      const Span<double> internal = Span<double>(state.z()).part(at(z.offset), at(z.size)),
                         history = Span<double>(state.h()).part(at(h.offset), at(h.size));
      if (!system_.joint(j).initialize(system_.input(j, point(state), e), internal, history, message) ||
          !keeps_finite(internal, history, "initialize", message)) {
        throw Error(Error::Category::plugin, "plugin-failed",
                    fmt::format("joint '{}' of {} failed at its start: {}", model_.joints[at(j)].name,
                                model_.instances.words_of(*model_.joints[at(j)].component), message.text),
                    model_.joints[at(j)].location);
      }
    }
  }

  ConstraintFacts facts_of(const System& system) {
    const bool closed = system.variant() == Variant::closed;
    Evaluation e(system);
    State state(system.layout(), 0);
    state.t() = state_.t();
    std::ranges::copy(state_.q(), state.q().begin());
    std::ranges::copy(state_.v(), state.v().begin());
    if (closed) std::ranges::copy(state_.h(), state.h().begin());
    if (!system.evaluate(point(state), term_position | term_velocity, e)) throw_fault(model_, e.fault);
    return constraint_facts(system, e);
  }

  System& system_;
  const OffsetChange& change_;
  const Model& model_;
  System closed_;
  State state_;
  Evaluation e_;
  std::vector<double> held_;    // by joint
  std::vector<int> leads_;      // joints that lead and are not driven
  std::vector<char> held_row_;  // rows of the closed system that hold positions
  std::vector<char> followed_;  // inverse-kinematics entries with drivers without a closed form
  std::optional<GearTurns> gear_turns_;
  std::vector<PathRow> paths_;  // that hold positions in place of their drivers
};

}  // namespace

ModelFacts count_facts(const Model& model) {
  ModelFacts facts;
  facts.bodies = static_cast<int>(model.bodies.size());
  facts.joints = static_cast<int>(std::ranges::count(model.joints, false, &JointElement::is_force));
  facts.clearance_joints = model.clearance_joints();
  facts.drivers = static_cast<int>(model.drivers.size());
  const auto count = [&](Variant variant, ConstraintFacts& out) {
    const Layout layout(model, variant);
    facts.coordinates = layout.nq();
    facts.velocities = layout.nv();
    facts.driver_constraints = layout.nc() - layout.first_driver_row();
    out = {layout.first_driver_row(), -1, -1, -1, -1, -1};
  };
  if (facts.clearance_joints > 0) count(Variant::closed, facts.ideal.emplace());
  count(Variant::released, facts.actual);
  return facts;
}

Start assemble(System& system, const OffsetChange& change) { return Assembler(system, change).run(); }

}  // namespace freeplay
