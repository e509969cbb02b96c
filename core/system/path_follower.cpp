#include "system/path_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/index.h"

namespace freeplay {
namespace {

// All lengths are relative to the size of the model, angles in rad.
constexpr int most_iterations = 12;
constexpr double last_correction = 1e-9;  // what is left is its square
constexpr double residual_limit = 1e-9;   // rows that contradict each other leave more
constexpr double longest_way = 0.1;       // from a prediction to the solution
constexpr double same_place = 1e-8;       // of solutions that were reached on two ways
constexpr int fewest_pieces = 128;        // of a run
constexpr double shortest_piece = 1e-9;   // of a run

}  // namespace

PathFollower::Work::Work(const System& system, int rows)
    : state(system.layout(), 0),
      e(system),
      solver(rows, system.layout().nv()),
      right(at(rows)),
      step(at(system.layout().nv())) {}

PathFollower::PathFollower(const System& closed, std::span<const double> q, std::span<const double> h)
    : model_(closed.model()), system_(closed.model(), Variant::closed), lost_(std::numeric_limits<double>::infinity()) {
  system_.take_start_of(closed);
  for (int r = 0; r < system_.layout().nc(); ++r) kept_.push_back(r);
  for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
    if (!system_.motions().follows(d)) continue;
    drivers_.push_back(d);
  }
  for (int k = 0; k < static_cast<int>(model_.kinematics.size()); ++k) {
    if (!system_.motions().entry_follows(k)) continue;
    const InverseKinematics& entry = model_.kinematics[at(k)];
    for (int d = 0; d < entry.driver_count; ++d) std::erase(kept_, system_.layout().driver_row(entry.first_driver + d));
    const std::vector<PathRow> rows = path_rows(model_, k);
    paths_.insert(paths_.end(), rows.begin(), rows.end());
  }
  row_of_.assign(at(system_.layout().nc()), -1);
  for (std::size_t i = 0; i < kept_.size(); ++i) row_of_[at(kept_[i])] = static_cast<int>(i);
  Work work(system_, rows());
  State start(system_.layout(), 0);
  start.t() = model_.settings.start;
  std::ranges::copy(q, start.q().begin());
  std::ranges::copy(h, start.h().begin());
  MotionFault fault;
  if (solve(start.t(), start, work, fault) != Found::yes) {
    const InverseKinematics& entry = model_.kinematics[at(paths_.front().kinematics)];
    fail(start.t(), fault);
    throw Error(Error::Category::input, fault.id, fault.text, entry.path_location);
  }
  way_.push_back(work.state);
  find_way();
}

// Pieces grow while their ends lead to the same place half-way, and shrink where they do not.
void PathFollower::find_way() {
  const double start = model_.settings.start, end = model_.settings.end;
  const double longest = (end - start) / fewest_pieces;
  Work work(system_, rows()), other(system_, rows());
  MotionFault fault;
  for (double piece = longest; way_.back().t() < end;) {
    const double t = way_.back().t();
    double next = t + piece;
    if (next > end - 1e-3 * piece) next = end;
    if (solve(next, way_.back(), work, fault) == Found::yes && certain(way_.back(), work.state, other)) {
      way_.push_back(work.state);
      piece = std::min(2.0 * piece, longest);
      continue;
    }
    piece *= 0.5;
    if (piece >= shortest_piece * (end - start)) continue;
    lost_ = t;
    return;
  }
}

bool PathFollower::certain(const State& left, const State& right, Work& work) {
  const double middle = 0.5 * (left.t() + right.t());
  MotionFault fault;
  if (solve(middle, left, work, fault) != Found::yes) return false;
  const std::vector<double> q(work.state.q().begin(), work.state.q().end());
  return solve(middle, right, work, fault) == Found::yes && distance(q, work.state.q()) <= same_place;
}

double PathFollower::distance(std::span<const double> a, std::span<const double> b) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]) / (i % 3 == 2 ? 1.0 : system_.size()));
  }
  return largest;
}

double PathFollower::scaled(std::span<const double> step) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < step.size(); ++i) {
    const double size = std::abs(step[i]) / (i % 3 == 2 ? 1.0 : system_.size());
    if (!(size <= largest)) largest = size;  // keeps a NaN
  }
  return largest;
}

// Jacobian and -residual of the rows that stay and of the paths, at the coordinates and velocities in the state.
bool PathFollower::assemble(double t, Work& work, MotionFault& fault) const noexcept {
  work.state.t() = t;
  const Point here = point(work.state);
  if (!system_.evaluate(here, term_position | term_velocity | term_acceleration | term_coordinate, work.e)) {
    fault = work.e.fault.motion;
    if (work.e.fault.kind != Fault::Kind::motion) {
      fault.id = "plugin-failed";
      abi::copy_text(fault.text, sizeof fault.text, work.e.fault.message.text);
    }
    return false;
  }
  system_.jacobian().list(work.e.jacobian, work.entries);
  work.solver.matrix.setZero();
  for (const SparseEntry& entry : work.entries) {
    if (const int row = row_of_[at(entry.row())]; row >= 0) work.solver.matrix(row, entry.col()) += entry.value();
  }
  for (std::size_t i = 0; i < kept_.size(); ++i) work.right[i] = -work.e.phi[at(kept_[i])];
  for (std::size_t p = 0; p < paths_.size(); ++p) {
    const PathRow& path = paths_[p];
    const int r = static_cast<int>(kept_.size() + p);
    PathPose pose;
    if (!system_.motions().path(path.kinematics, t, pose, fault)) return false;
    double row[3] = {};
    if (path.body != ground) path.entries(work.e, row);
    for (int c = 0; c < 3 && path.body != ground; ++c) work.solver.matrix(r, 3 * path.body + c) = row[c];
    work.right[at(r)] = -path.residual(system_, here, work.e, pose[at(path.component)].value);
  }
  return true;
}

PathFollower::Found PathFollower::solve(double t, const State& from, Work& work, MotionFault& fault) const noexcept {
  State& state = work.state;
  state.assign(from);
  const double dt = t - from.t();
  const std::span<double> q = state.q(), v = state.v(), a = state.a();
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += dt * (v[i] + 0.5 * dt * a[i]);
  double travelled = 0.0, correction = 1.0;
  for (int iteration = 0; correction > last_correction; ++iteration) {
    if (iteration == most_iterations) return Found::no;
    if (!assemble(t, work, fault)) return Found::fault;
    if (!work.solver.factor()) return Found::no;
    work.solver.solve(work.right, work.step);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += work.step[i];
    correction = scaled(work.step);
    travelled += correction;
    if (!(travelled <= longest_way)) return Found::no;
  }
  // Speeds first, for accelerations depend on them.
  if (!assemble(t, work, fault)) return Found::fault;
  if (!work.solver.factor() || !(scaled(work.right) <= residual_limit)) return Found::no;
  PathPose pose;
  for (const bool speeds : {true, false}) {
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      work.right[i] = speeds ? work.e.nu[at(kept_[i])] : work.e.gamma[at(kept_[i])];
    }
    for (std::size_t p = 0; p < paths_.size(); ++p) {
      const PathRow& path = paths_[p];
      if (!system_.motions().path(path.kinematics, t, pose, fault)) return Found::fault;
      const Jet& wanted = pose[at(path.component)];
      work.right[kept_.size() + p] = speeds ? wanted.rate : path.gamma(work.e, wanted.acceleration);
    }
    work.solver.solve(work.right, speeds ? v : a);
    if (speeds && !assemble(t, work, fault)) return Found::fault;
  }
  for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
    if (const int turn = system_.layout().turn(j); turn >= 0) state.h()[at(turn)] = work.e.coordinate[at(j)];
  }
  return Found::yes;
}

const State& PathFollower::nearest(double t) const {
  const auto after = std::upper_bound(way_.begin() + 1, way_.end(), t,
                                      [](double time, const State& state) { return time < state.t(); });
  if (after == way_.end()) return way_.back();
  const State& before = *(after - 1);
  return t - before.t() <= after->t() - t ? before : *after;
}

void PathFollower::fail(double t, MotionFault& fault) const noexcept {
  fault.kinematics = paths_.front().kinematics;
  fault.id = "ik-unreachable";
  const auto end =
      fmt::format_to_n(fault.text, sizeof fault.text - 1, "the mechanism cannot follow the path at t = {:.9g} s{}", t,
                       paths_.size() > 3 ? " (of this entry or another)" : "");
  *end.out = '\0';
}

std::unique_ptr<FollowedMotion::Work> PathFollower::make_work() const {
  return std::make_unique<Work>(system_, rows());
}

bool PathFollower::reach(double t, Work& work, MotionFault& fault) const noexcept {
  const Found found = t > lost_ + shortest_piece * (model_.settings.end - model_.settings.start)
                          ? Found::no
                          : solve(t, nearest(t), work, fault);
  if (found == Found::no) fail(t, fault);
  return found == Found::yes;
}

bool PathFollower::evaluate(double t, Span<TimeValue> out, FollowedMotion::Work& own,
                            MotionFault& fault) const noexcept {
  Work& work = static_cast<Work&>(own);
  if (!reach(t, work, fault)) return false;
  for (const int d : drivers_) {
    const int j = model_.drivers[at(d)].joint;
    const JointElement& joint = model_.joints[at(j)];
    double row[6], bias = 0.0;
    system_.joints().coordinate_row(j, work.e, row, bias);
    TimeValue& value = out[at(d)];
    value = {work.e.coordinate[at(j)], 0.0, bias};
    const BodyId bodies[2] = {model_.markers[at(joint.marker_a)].body, model_.markers[at(joint.marker_b)].body};
    for (std::size_t k = 0; k < 2; ++k) {
      if (bodies[k] == ground) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        value.rate += row[3 * k + c] * work.state.v()[3 * at(bodies[k]) + c];
        value.acceleration += row[3 * k + c] * work.state.a()[3 * at(bodies[k]) + c];
      }
    }
  }
  return true;
}

bool PathFollower::frame(int kinematics, double t, PathPose& pose, FollowedMotion::Work& own,
                         MotionFault& fault) const noexcept {
  Work& work = static_cast<Work&>(own);
  if (!reach(t, work, fault)) return false;
  const int marker = model_.kinematics[at(kinematics)].marker;
  const BodyId body = model_.markers[at(marker)].body;
  const Evaluation& e = work.e;
  const MarkerKinematics& k = e.markers[at(marker)];
  const double rest[3] = {0.0, 0.0, 0.0};
  double acceleration[6];
  planar::marker_acceleration(body == ground ? rest : &work.state.a()[3 * at(body)], e.arms[at(marker)], acceleration);
  pose[0] = {k.position[0], k.velocity[0], acceleration[0]};
  pose[1] = {k.position[1], k.velocity[1], acceleration[1]};
  pose[2] = {system_.markers().angle(marker, work.state.q()), k.angular_velocity[2], acceleration[5]};
  return true;
}

}  // namespace freeplay
