#include "assembly/warm_start.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <fmt/format.h>

#include "assembly/closed_mechanism.h"
#include "assembly/play_gap.h"
#include "base/angle.h"
#include "base/index.h"
#include "linear/row_solutions.h"
#include "stage/newton_stage_solver.h"

namespace freeplay {
namespace {

constexpr double open_without_play = 1e-3;  // of the size of the model
constexpr double tied = 1.0;                // by which a whole turn opens the rows of a joint that keeps it [rad]

[[noreturn]] void refuse(const std::string& message) { throw Error(Error::Category::numerical, "warm-start", message); }

class WarmStart {
 public:
  WarmStart(System& system, const EndedMotion& motion, Start& start)
      : system_(system),
        model_(system.model()),
        start_(start),
        state_(start.state),
        e_(system),
        turns_(model_.bodies.size(), 0.0),
        known_(model_.bodies.size(), 0) {
    const bool same = motion.q.size() == state_.q().size() && motion.v.size() == state_.v().size() &&
                      motion.z.size() == state_.z().size() && motion.h.size() == state_.h().size();
    if (!same) refuse("the point before it in the chain has other bodies, joints or coordinates");
    std::ranges::copy(motion.q, state_.q().begin());
    std::ranges::copy(motion.v, state_.v().begin());
    std::ranges::copy(motion.z, state_.z().begin());
    std::ranges::copy(motion.h, state_.h().begin());
    state_.t() = model_.settings.start;
    move_times(model_.settings.start - motion.t);
  }

  void run() {
    take_turns_back();
    keep_offsets();
    close();
    settle_velocities();
    start_.report = {};
  }

 private:
  void evaluate(unsigned terms) {
    if (!system_.evaluate(point(state_), terms | term_coordinate, e_)) throw_fault(model_, e_.fault);
  }

  /// A number that a joint begins with, and that grows with the time at which it begins, is a time.
  void move_times(double by) {
    evaluate(term_position);
    for (int j = 0; j < joints(); ++j) {
      const Slice z = system_.layout().internal(j), h = system_.layout().history(j);
      std::vector<double> internal(at(z.size)), early(at(h.size)), late(at(h.size));
      JointInput in = system_.joints().input(j, point(state_), e_);
      Message message;
      const auto begin = [&](std::vector<double>& history) {
        return system_.joints().handle(j).initialize(in, {internal.data(), internal.size()},
                                                     {history.data(), history.size()}, message);
      };
      if (h.size == 0 || !begin(early)) continue;
      in.t += 1.0;
      if (!begin(late)) continue;
      for (std::size_t i = 0; i < early.size(); ++i) {
        if (std::abs(late[i] - early[i] - 1.0) < 1e-9) state_.h()[at(h.offset) + i] += by;
      }
    }
  }

  int joints() const { return static_cast<int>(model_.joints.size()); }
  BodyId first_body(int joint) const { return model_.markers[at(model_.joints[at(joint)].marker_a)].body; }
  BodyId second_body(int joint) const { return model_.markers[at(model_.joints[at(joint)].marker_b)].body; }
  bool is_known(BodyId body) const { return body == ground || known_[at(body)] != 0; }
  double turns_of(BodyId body) const { return body == ground ? 0.0 : turns_[at(body)]; }
  void know(BodyId body, double turns) {
    turns_[at(body)] = turns;
    known_[at(body)] = 1;
  }
  bool is_angle(int joint) const {
    return model_.joints[at(joint)].gear < 0 && system_.joints().layout(joint).coordinate == Coordinate::angle;
  }
  /// 1 or -1: how the joint's angle grows with that of its second body, in the plane.
  double sense(int joint) const {
    double row[12], bias = 0.0;
    system_.joints().coordinate_row(joint, e_, row, bias);
    return row[5] < 0.0 || row[2] > 0.0 ? -1.0 : 1.0;
  }

  struct Turn {
    int joint;
    double turns;  // of its angle
  };

  void take_turns_back() {
    evaluate(term_position);
    std::vector<Turn> wanted;
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (!prescribes(driver.kind) || !is_angle(driver.joint)) continue;
      if (driver.kind == DriverKind::velocity || system_.motions().modulo_turns(d)) continue;
      const double off = e_.motion[at(d)].value - e_.coordinate[at(driver.joint)];
      wanted.push_back({driver.joint, std::round(off / whole_turn)});
    }
    if (model_.space == Space::spatial) {
      for (const Turn& turn : wanted) move_count(turn.joint, turn.turns);
    } else {
      turn_bodies(wanted);
    }
    evaluate(term_position);
    for (int j = 0; j < joints(); ++j) {
      if (const int turn = system_.layout().turn(j); turn >= 0) state_.h()[at(turn)] = e_.coordinate[at(j)];
    }
  }

  void move_count(int joint, double turns) {
    if (const int turn = system_.layout().turn(joint); turn >= 0) state_.h()[at(turn)] += whole_turn * turns;
  }

  void turn_bodies(const std::vector<Turn>& wanted) {
    for (bool more = true; more;) {
      more = false;
      for (const Turn& turn : wanted) more = relate(turn) || more;
      if (!more) more = follow_gears() || follow_ties();
      if (more) continue;
      // A chain of driven joints that hangs on nothing driven: its first body stays.
      for (const Turn& turn : wanted) {
        if (is_known(first_body(turn.joint)) || is_known(second_body(turn.joint))) continue;
        know(first_body(turn.joint), 0.0);
        more = true;
        break;
      }
    }
    for (std::size_t b = 0; b < turns_.size(); ++b) angle_of(static_cast<BodyId>(b)) += whole_turn * turns_[b];
    for (int j = 0; j < joints(); ++j) {
      const double turns = turns_of(second_body(j)) - turns_of(first_body(j));
      if (turns != 0.0 && is_angle(j)) move_count(j, sense(j) * turns);
    }
  }

  double& angle_of(BodyId body) { return state_.q()[3 * at(system_.layout().place(body)) + 2]; }

  /// The second body of a joint follows from the first, or the other way round. False where both are known, or none.
  bool relate(const Turn& turn) {
    const BodyId a = first_body(turn.joint), b = second_body(turn.joint);
    if (is_known(a) == is_known(b)) return false;
    const double between = sense(turn.joint) * turn.turns;
    is_known(a) ? know(b, turns_of(a) + between) : know(a, turns_of(b) - between);
    return true;
  }

  double turned_coordinate(int joint) const {
    const double turns = is_angle(joint) ? turns_of(second_body(joint)) - turns_of(first_body(joint)) : 0.0;
    return e_.coordinate[at(joint)] + (turns == 0.0 ? 0.0 : sense(joint) * turns * whole_turn);
  }

  bool follow_gears() {
    const auto settled = [&](int joint) { return is_known(first_body(joint)) && is_known(second_body(joint)); };
    const auto turns_to = [&](int joint, double coordinate) {
      return Turn{joint, std::round((coordinate - e_.coordinate[at(joint)]) / whole_turn)};
    };
    for (const Gear& gear : model_.gears) {
      if (!gear.offset) continue;
      if (settled(gear.first) && is_angle(gear.second)) {
        if (relate(turns_to(gear.second, gear.ratio * turned_coordinate(gear.first) + *gear.offset))) return true;
      }
      if (settled(gear.second) && is_angle(gear.first)) {
        if (relate(turns_to(gear.first, (turned_coordinate(gear.second) - *gear.offset) / gear.ratio))) return true;
      }
    }
    return false;
  }

  /// Bodies that no joint lets turn against each other turn together.
  bool follow_ties() {
    for (int j = 0; j < joints(); ++j) {
      const BodyId a = first_body(j), b = second_body(j);
      if (model_.joints[at(j)].gear >= 0 || is_known(a) == is_known(b)) continue;
      const BodyId moved = is_known(a) ? a : b, other = is_known(a) ? b : a;
      if (turns_of(moved) == 0.0 || !opens(j, moved, turns_of(moved))) continue;
      know(other, turns_of(moved));
      return true;
    }
    return false;
  }

  bool opens(int joint, BodyId body, double turns) {
    const Slice rows = system_.layout().rows(joint);
    const std::vector<double> before(e_.phi.begin() + rows.offset, e_.phi.begin() + rows.offset + rows.size);
    const double angle = angle_of(body);
    angle_of(body) += whole_turn * turns;
    evaluate(term_position);
    double by = 0.0;
    for (std::size_t r = 0; r < before.size(); ++r)
      by = std::max(by, std::abs(e_.phi[at(rows.offset) + r] - before[r]));
    angle_of(body) = angle;
    evaluate(term_position);
    return by > tied;
  }

  /// Gears that keep the offset that they find, and drivers of speeds, go on from here.
  void keep_offsets() {
    for (int g = 0; g < static_cast<int>(model_.gears.size()); ++g) {
      const Gear& gear = model_.gears[at(g)];
      if (gear.offset) continue;
      system_.set_gear_offset(g, e_.coordinate[at(gear.second)] - gear.ratio * e_.coordinate[at(gear.first)]);
    }
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (driver.kind == DriverKind::velocity) system_.motions().set_start(d, e_.coordinate[at(driver.joint)]);
    }
    e_.forget_motions();
    evaluate(term_position);
  }

  Eigen::Vector3d gap(int joint) const {
    const JointElement& one = model_.joints[at(joint)];
    const MarkerKinematics &a = e_.markers[at(one.marker_a)], &b = e_.markers[at(one.marker_b)];
    return play_gap(one, model_.space, a, b);
  }

  void close() {
    refuse_open_rows();
    std::vector<Eigen::Vector3d> gaps;
    for (int j = 0; j < joints(); ++j) gaps.push_back(model_.joints[at(j)].has_play ? gap(j) : Eigen::Vector3d::Zero());
    converge();
    for (int j = 0; j < joints(); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      const double clearance = system_.joints().layout(j).clearance;
      if (!joint.has_play || !(clearance > 0.0)) continue;
      const double moved = (gap(j) - gaps[at(j)]).norm();
      if (moved > clearance) {
        refuse(
            fmt::format("joint '{}' would be moved by {:.3g} m, more than its radial clearance of {:.3g} m: the drive "
                        "must be in the same phase at both ends of the run",
                        joint.name, moved, clearance));
      }
    }
  }

  void refuse_open_rows() const {
    const auto check = [&](Slice rows, const char* kind, const std::string& name) {
      double open = 0.0;
      for (int r = rows.offset; r < rows.offset + rows.size; ++r) open = std::max(open, std::abs(e_.phi[at(r)]));
      if (open <= open_without_play * system_.size()) return;
      refuse(
          fmt::format("{} '{}' is {:.3g} m or rad from where it must be: the drive must be in the same phase at both "
                      "ends of the run",
                      kind, name, open));
    };
    for (int j = 0; j < joints(); ++j) check(system_.layout().rows(j), "joint", model_.joints[at(j)].name);
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const int row = system_.layout().driver_row(d);
      if (row >= 0) check({row, 1}, "driver", model_.drivers[at(d)].name);
    }
  }
  void converge() {
    const int nc = system_.layout().nc();
    const double tolerance = model_.settings.assembly_tolerance;
    std::vector<SparseEntry> entries;
    for (int iteration = 0; iteration < model_.settings.assembly_iterations; ++iteration) {
      const Eigen::Map<const Eigen::VectorXd> phi(e_.phi.data(), nc);
      if (nc == 0 || phi.lpNorm<Eigen::Infinity>() <= 1e-3 * tolerance) return;
      entries.clear();
      system_.jacobian().list(e_.jacobian, entries);
      const Eigen::VectorXd step = least_norm_solution(sparse_matrix(nc, system_.layout().nv(), entries), -phi);
      const std::vector<double> q(state_.q().begin(), state_.q().end());
      system_.coordinates().retract(q, {step.data(), at(static_cast<int>(step.size()))}, state_.q());
      const double before = phi.lpNorm<Eigen::Infinity>();
      evaluate(term_position);
      const double after = Eigen::Map<const Eigen::VectorXd>(e_.phi.data(), nc).lpNorm<Eigen::Infinity>();
      if (after <= tolerance && after > 0.1 * before) return;
    }
    refuse("the positions at the end of the point before it cannot be corrected to the constraints");
  }

  void settle_velocities() {
    NewtonStageSolver solver(system_, {});
    solver.use_history(state_.h());
    StateView view = state_.view();
    std::vector<double> z_rate(state_.z().size());
    if (solver.project_velocity(view) && solver.accelerate(view, {z_rate.data(), z_rate.size()})) return;
    if (solver.fault().kind != Fault::Kind::none) throw_fault(model_, solver.fault());
    refuse(fmt::format("the velocities at the end of the point before it cannot be corrected: {}", solver.trouble()));
  }

  System& system_;
  const Model& model_;
  Start& start_;
  State& state_;
  Evaluation e_;
  std::vector<double> turns_;  // by body, by which its angle is moved
  std::vector<char> known_;
};

}  // namespace

void start_from(System& system, const EndedMotion& motion, Start& start) { WarmStart(system, motion, start).run(); }

}  // namespace freeplay
