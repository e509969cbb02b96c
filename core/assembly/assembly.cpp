#include "assembly/assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>

#include "assembly/bare_start.h"
#include "assembly/closed_mechanism.h"
#include "assembly/dead_point.h"
#include "assembly/even_spread.h"
#include "assembly/failure.h"
#include "assembly/force_turns.h"
#include "assembly/gear_turn_choice.h"
#include "assembly/idle_elements.h"
#include "assembly/leg_modes.h"
#include "assembly/locked_parts.h"
#include "assembly/placing.h"
#include "assembly/play_rows.h"
#include "assembly/start_branches.h"
#include "assembly/start_overlap.h"
#include "assembly/start_rows.h"
#include "assembly/start_velocities.h"
#include "base/index.h"
#include "component/joint_answer.h"
#include "stage/newton_stage_solver.h"
#include "system/path_follower.h"

namespace freeplay {
namespace {

using Eigen::VectorXd;

/// What is found out besides the state itself.
enum class Account { full, none };

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int most_rounds_of_loads = 6;
constexpr double same_tilt = 1e-10;  // of a tilt

/// Whether any tilt has changed.
bool tilts_otherwise(const std::vector<InitialOffset>& before, const std::vector<InitialOffset>& now) {
  for (std::size_t j = 0; j < now.size(); ++j) {
    double apart = 0.0, size = 0.0;
    for (int i = 0; i < 3; ++i) {
      apart = std::hypot(apart, now[j].tilt[i] - before[j].tilt[i]);
      size = std::hypot(size, now[j].tilt[i]);
    }
    if (apart > same_tilt * size) return true;
  }
  return false;
}

// The closed mechanism at the start time and the rows that hold it there.
class Assembler {
 public:
  Assembler(System& system, const OffsetChange& change, Account account)
      : system_(system),
        change_(change),
        account_(account),
        model_(system.model()),
        mechanism_(system),
        closed_(mechanism_.system),
        state_(mechanism_.state),
        e_(mechanism_.e) {}

  Start run() {
    choose_held_coordinates();
    place_bodies(closed_, held_, state_.q());
    remember_turns();
    if (std::ranges::any_of(followed_, [](char yes) { return yes != 0; })) follow_paths();
    set_offsets({});
    solve_positions();
    check_paths();
    solve_speeds();
    // A journal that tilts moves its loads, and they what it stands off by.
    for (int round = 0; round < most_rounds_of_loads; ++round) {
      const std::vector<InitialOffset> before = offsets_;
      if (!load_journals()) break;
      solve_positions();
      solve_speeds();
      if (!tilts_otherwise(before, offsets_)) break;
    }
    if (account_ == Account::full) {
      report_.moved = moved_starts(closed_, state_.q(), state_.v());
      report_moved_journals();
    }
    return release();
  }

 private:
  void evaluate(unsigned terms) { mechanism_.evaluate(terms); }

  // Values that joints lead or are driven to at the start. A driver of a speed starts where `initial` says.
  void choose_held_coordinates() {
    held_.assign(model_.joints.size(), nan);
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
        mechanism_.held_row[at(closed_.layout().driver_row(d))] = 0;
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
      if (!gear.offset) mechanism_.held_row[at(closed_.layout().rows(gear.joint).offset)] = 0;
    }
    for (int k = 0; k < static_cast<int>(model_.kinematics.size()); ++k) {
      followed_.push_back(closed_.motions().entry_follows(k) ? 1 : 0);
    }
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const auto& start = model_.joints[at(j)].start_coordinate;
      if (start && !driven[at(j)]) mechanism_.leads.push_back({j, start->value});
    }
  }

  // Angles are counted from the value that a joint leads or is driven to, else as a gear says, else from (-pi, pi].
  void remember_turns() {
    gear_turns_.count(false);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const int turn = closed_.layout().turn(j);
      if (turn >= 0) state_.h()[at(turn)] = std::isnan(held_[at(j)]) ? 0.0 : held_[at(j)];
    }
  }

  // Driven joints without a closed form: the ideal mechanism stands on the paths, which gives where the joints are now
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
    mechanism_.paths.clear();
    for (int k = 0; k < static_cast<int>(model_.kinematics.size()); ++k) {
      if (!followed_[at(k)]) continue;
      const InverseKinematics& entry = model_.kinematics[at(k)];
      for (int d = 0; d < entry.driver_count; ++d) {
        mechanism_.held_row[at(closed_.layout().driver_row(entry.first_driver + d))] = drivers ? 1 : 0;
      }
      const std::vector<PathRow> rows = path_rows(model_, k);
      if (!drivers) mechanism_.paths.insert(mechanism_.paths.end(), rows.begin(), rows.end());
    }
  }

  // Starts of the joints with play; `reactions` hold a wrench for each joint, or nothing yet.
  bool set_offsets(const std::vector<std::array<double, 6>>& reactions) {
    bool moved = false;
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (!joint.has_play) continue;
      std::array<double, 6> wrench = reactions.empty() ? std::array<double, 6>{} : reactions[at(j)];
      InitialOffset offset{};
      Message message;
      if (!reactions.empty()) {
        offset.a = &e_.markers[at(joint.marker_a)];
        offset.b = &e_.shifted[at(j)];
        offset.rotation = offset.a->rotation;
      }
      if (!joint.joint.initial_offset({wrench.data(), wrench.size()}, offset, message)) {
        throw Error(Error::Category::input, "assembly-failed",
                    fmt::format("joint '{}' has no start: {}", joint.name, message.text), joint.location);
      }
      offset.rotation = nullptr;
      offset.a = offset.b = nullptr;
      if (change_) change_(j, offset);
      moved = moved || !reactions.empty();
      offsets_[at(j)] = offset;
      closed_.set_offset(j, offset);
    }
    return moved;
  }

  // Newton cannot leave a guess with all links in one line, where no small turn changes the gap at first order: files
  // that give no pose begin so. Then the bodies are turned a little, each by another fixed angle.
  bool converge_from_turned(const std::vector<double>& guess) {
    for (const double turn : {0.1, 0.5, 1.5}) {
      std::ranges::copy(guess, state_.q().begin());
      closed_.coordinates().retract(guess, spread_turns(closed_, turn), state_.q());
      if (mechanism_.holds(mechanism_.converge())) return true;
    }
    return false;
  }

  // The first time the nearest position is looked for; later ones stay close to it.
  void solve_positions() {
    const std::vector<double> guess(state_.q().begin(), state_.q().end());
    const bool first = !nearest_is_known_;
    bool found = mechanism_.holds(mechanism_.converge()), chosen_by_turn = false;
    const std::vector<double> nearest(state_.q().begin(), state_.q().end());
    if (!found) found = gear_turns_.from_slides(guess) || (chosen_by_turn = converge_from_turned(guess));
    if (first && gear_turns_.from_other_turns(guess, found)) found = true, chosen_by_turn = false;
    if (!std::exchange(nearest_is_known_, true)) found = take_nearest(guess, found, chosen_by_turn);
    if (!found) found = yield(guess, first);
    if (!found) {
      std::ranges::copy(nearest, state_.q().begin());
      if (!mechanism_.paths.empty()) check_paths();
      require_borne_loads(model_, offsets_);
      throw_open(mechanism_, mechanism_.position_rows());
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

  // Redundant constraints that close with all journals centred leave these fewer places than they have directions.
  bool yield(const std::vector<double>& guess, bool first) {
    const auto moves = [](const InitialOffset& one) {
      return std::hypot(one.position[0], one.position[1], one.position[2]) > 0.0 ||
             std::hypot(one.tilt[0], one.tilt[1], one.tilt[2]) > 0.0;
    };
    if (std::ranges::none_of(offsets_, moves)) return false;
    for (int j = 0; j < static_cast<int>(offsets_.size()); ++j) {
      if (model_.joints[at(j)].has_play) closed_.set_offset(j, {});
    }
    std::ranges::copy(guess, state_.q().begin());
    bool centred = mechanism_.holds(mechanism_.converge());
    if (first) {
      bool chosen_by_turn = false;
      if (!centred) centred = gear_turns_.from_slides(guess) || (chosen_by_turn = converge_from_turned(guess));
      centred = take_nearest(guess, centred, chosen_by_turn);
    }
    const auto given = [&](const JointElement& joint) { return !change_ && gives_eccentricity(joint); };
    const bool found = centred && yield_in_play(mechanism_, offsets_, play_ranks(mechanism_, given));
    for (int j = 0; j < static_cast<int>(offsets_.size()); ++j) {
      if (model_.joints[at(j)].has_play) closed_.set_offset(j, offsets_[at(j)]);
    }
    evaluate(term_position | term_velocity);
    return found;
  }

  void solve_speeds() {
    const std::span<const double> mass = system_.inertia().mass();
    if (account_ == Account::full) {
      report_.chosen = solve_velocities(mechanism_, mass);
    } else {
      solve_bare_velocities(mechanism_, mass);
    }
  }

  // Of journals whose block says where or how fast they start.
  void report_moved_journals() {
    const std::vector<PlayRank> ranks = play_ranks(mechanism_, [](const JointElement&) { return true; });
    const ClosedMechanism::Rows speeds = mechanism_.speed_rows({});
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      if (!joint.has_play) continue;
      const Slice slice = closed_.layout().rows(j);
      double apart = 0.0, rate = 0.0;
      for (int r = slice.offset; r < slice.offset + slice.size; ++r) {
        if (ranks[at(r)] != PlayRank::given) continue;
        apart = std::hypot(apart, e_.phi[at(r)]);
        rate = std::hypot(rate, speeds.residual[r]);
      }
      add_moved_journal(joint, gives_velocity(joint), offsets_[at(j)], apart, rate, report_.moved);
    }
  }

  // Where Newton has left a given pose, or came from a guess from which two ways could not be distinguished.
  bool take_nearest(const std::vector<double>& guess, bool found, bool chosen_by_turn) {
    if (found && !chosen_by_turn && StartBranches::keeps(GivenPoses(closed_), state_.q())) return true;
    StartBranches branches(mechanism_, guess);
    if (found) branches.add_found();
    branches.search();
    if (!branches.any()) return false;
    branches.take_nearest();
    if (const auto other = branches.as_near()) report_.twins.push_back(twin_start(closed_, state_.q(), *other));
    return true;
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

  void check_paths() {
    evaluate(term_position | term_velocity);
    freeplay::check_paths(closed_, e_);
  }

  // Journals that rest in their bearings need the reactions of the ideal mechanism.
  bool load_journals() {
    if (model_.clearance_joints() == 0) return false;
    NewtonStageSolver solver(closed_, {});
    solver.use_history(state_.h());
    StateView view = state_.view();
    if (!solver.accelerate(view, view.z)) return false;  // the released mechanism decides
    evaluate(term_position | term_velocity | term_force);
    std::vector<std::array<double, 6>> reactions(model_.joints.size());
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      closed_.constraints().reaction(j, e_, state_.lambda(), reactions[at(j)].data());
    }
    return set_offsets(reactions);
  }

  Start release() {
    const bool full = account_ == Account::full;
    ConstraintFacts ideal;
    if (full && model_.clearance_joints() > 0) ideal = facts_of(closed_);
    evaluate(term_position | term_velocity);
    Start start{State(system_.layout(), 0), count_facts(model_), {}, std::move(report_)};
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
    if (full) refuse_overlap(system_, state, released);
    NewtonStageSolver solver(system_, {});
    solver.use_history(state.h());
    StateView view = state.view();
    std::vector<double> z_rate(state.z().size());
    if (!solver.accelerate(view, {z_rate.data(), z_rate.size()})) {
      if (solver.fault().kind != Fault::Kind::none) throw_fault(model_, solver.fault());
      throw Error(Error::Category::input, "singular-mass", solver.trouble());
    }
    start.facts.actual = facts_of(system_);
    if (!full) return start;
    if (model_.clearance_joints() > 0) start.facts.ideal = ideal;
    start.structure = examine_structure(system_, released, start.state, closed_, e_, dead_start(system_, start.state),
                                        unstable_start(system_, start.state));
    doubt_locked(system_, start.state, start.structure);
    judge_elements(state, start.structure);
    return start;
  }

  void judge_elements(const State& state, Structure& structure) {
    Evaluation e(system_);
    if (!system_.evaluate(point(state), term_position | term_velocity | term_coordinate, e))
      throw_fault(model_, e.fault);
    doubt_elements(system_, e, closed_, e_, structure);
  }

  void initialize_joints(State& state) {
    Evaluation e(system_);
    if (!system_.evaluate(point(state), term_coordinate, e)) throw_fault(model_, e.fault);
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const Slice z = system_.layout().internal(j), h = system_.layout().history(j);
      Message message;
      const Span<double> internal = Span<double>(state.z()).part(at(z.offset), at(z.size)),
                         history = Span<double>(state.h()).part(at(h.offset), at(h.size));
      if (!system_.joints().handle(j).initialize(system_.joints().input(j, point(state), e), internal, history,
                                                 message) ||
          !keeps_finite(internal, history, "initialize", message)) {
        const JointElement& joint = model_.joints[at(j)];
        if (message.id[0] != '\0') {
          throw Error(Error::Category::input, message.id,
                      fmt::format("{} '{}': {}", joint.is_force ? "force" : "joint", joint.name, message.text),
                      joint.location);
        }
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
    return constraint_facts(system.jacobian(), e);
  }

  System& system_;
  const OffsetChange& change_;
  const Account account_;
  const Model& model_;
  ClosedMechanism mechanism_;
  System& closed_;
  State& state_;
  Evaluation& e_;
  std::vector<double> held_;  // by joint
  GearTurnChoice gear_turns_{mechanism_, held_};
  std::vector<InitialOffset> offsets_ = std::vector<InitialOffset>(model_.joints.size(), InitialOffset{});
  std::vector<char> followed_;  // inverse-kinematics entries with drivers without a closed form
  StartReport report_;
  bool nearest_is_known_ = false;
};

}  // namespace

Start assemble(System& system, const OffsetChange& change) { return Assembler(system, change, Account::full).run(); }

Start assemble_bare(System& system, const OffsetChange& change) {
  return Assembler(system, change, Account::none).run();
}

}  // namespace freeplay
