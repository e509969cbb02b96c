#include "system/path_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/format_into.h"
#include "base/index.h"
#include "system/path_place.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

// All lengths are relative to the size of the model, angles in rad.
constexpr int most_iterations = 12;
constexpr double last_correction = 1e-9;  // what is left is its square
constexpr double residual_limit = 1e-9;   // rows that contradict each other leave more
constexpr double longest_way = 0.1;       // from a prediction to the solution

}  // namespace

PathFollower::Work::Work(const System& system, int rows)
    : state(system.layout(), 0),
      e(system),
      solver(rows, system.layout().nv()),
      right(at(rows)),
      step(at(system.layout().nv())),
      before(state.q().size()) {}

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
    if (nearness(work) < singular_start) lost_words_ = words_of_place(edge_at(start));
    fail(start.t(), fault);
    throw Error(Error::Category::input, fault.id, fault.text, entry.path_location);
  }
  way_.push_back(work.state);
  near_.push_back(nearness(work));
  clear_ = near_.front();
  find_way();
  // Speeds at such a start are rounding, from which the way soon gets lost.
  if (lost_words_.empty() && near_.front() < singular_start * clear_)
    lost_words_ = words_of_place(edge_at(way_.front()));
  note_edges();
}

double PathFollower::distance(std::span<const double> a, std::span<const double> b) const {
  std::vector<double> way(at(system_.layout().nv()));
  system_.coordinates().difference(b, a, way);
  return scaled(way);
}

double PathFollower::scaled(std::span<const double> step) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < step.size(); ++i) {
    const bool turn = system_.coordinates().is_turn(static_cast<int>(i));
    const double size = std::abs(step[i]) / (turn ? 1.0 : system_.size());
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
  const int width = system_.layout().body_velocities();
  for (std::size_t p = 0; p < paths_.size(); ++p) {
    const PathRow& path = paths_[p];
    const int r = static_cast<int>(kept_.size() + p);
    PathPose pose;
    if (!system_.motions().path(path.kinematics, t, pose, fault)) return false;
    double row[6] = {};
    if (path.body != ground) path.entries(system_, work.e, row);
    for (int c = 0; c < width && path.body != ground; ++c) work.solver.matrix(r, width * path.body + c) = row[c];
    work.right[at(r)] = -path.residual(system_, here, work.e, pose);
  }
  return true;
}

PathFollower::Found PathFollower::solve(double t, const State& from, Work& work, MotionFault& fault) const noexcept {
  State& state = work.state;
  state.assign(from);
  const double dt = t - from.t();
  const std::span<double> q = state.q(), v = state.v(), a = state.a();
  for (std::size_t i = 0; i < v.size(); ++i) work.step[i] = dt * (v[i] + 0.5 * dt * a[i]);
  system_.coordinates().retract(from.q(), work.step, q);
  double travelled = 0.0, correction = 1.0;
  for (int iteration = 0; correction > last_correction; ++iteration) {
    if (iteration == most_iterations) return Found::no;
    if (!assemble(t, work, fault)) return Found::fault;
    if (!work.solver.factor()) return Found::no;
    work.solver.solve(work.right, work.step);
    std::ranges::copy(q, work.before.begin());
    system_.coordinates().retract(work.before, work.step, q);
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
      work.right[kept_.size() + p] = speeds ? path.speed(pose) : path.gamma(system_, work.e, pose);
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
  const bool several = fault.kinematics != paths_.back().kinematics;
  char* const end = fault.text + sizeof fault.text - 1;
  char* to = format_into(fault.text, end, "the mechanism cannot follow the path at t = {:.9g} s{}", t,
                         several ? " (of this entry or another)" : "");
  to = write_place_on_path(model_, fault.kinematics, t, to, end);
  to = format_into(to, end, "{}", lost_words_);
  *to = '\0';
}

std::unique_ptr<FollowedMotion::Work> PathFollower::make_work() const {
  return std::make_unique<Work>(system_, rows());
}

bool PathFollower::reach(double t, Work& work, MotionFault& fault) const noexcept {
  const Found found = t > lost_ + shortest_path_piece * (model_.settings.end - model_.settings.start)
                          ? Found::no
                          : solve(t, nearest(t), work, fault);
  if (found == Found::no) fail(t, fault);
  return found == Found::yes;
}

bool PathFollower::evaluate(double t, Span<TimeValue> out, FollowedMotion::Work& own,
                            MotionFault& fault) const noexcept {
  for (const PathBridge& bridge : bridges_) {
    if (!bridge.covers(t)) continue;
    for (std::size_t i = 0; i < drivers_.size(); ++i) {
      const Jet value = bridge.driver(i, t);
      out[at(drivers_[i])] = {value.value, value.rate, value.acceleration};
    }
    return true;
  }
  Work& work = static_cast<Work&>(own);
  if (!reach(t, work, fault)) return false;
  evaluate_drivers(work, out);
  return true;
}

void PathFollower::evaluate_drivers(const Work& work, Span<TimeValue> out) const noexcept {
  const std::size_t width = at(system_.layout().body_velocities());
  for (const int d : drivers_) {
    const int j = model_.drivers[at(d)].joint;
    const JointElement& joint = model_.joints[at(j)];
    double row[12], bias = 0.0;
    system_.joints().coordinate_row(j, work.e, row, bias);
    TimeValue& value = out[at(d)];
    value = {work.e.coordinate[at(j)], 0.0, bias};
    const BodyId bodies[2] = {model_.markers[at(joint.marker_a)].body, model_.markers[at(joint.marker_b)].body};
    for (std::size_t k = 0; k < 2; ++k) {
      if (bodies[k] == ground) continue;
      for (std::size_t c = 0; c < width; ++c) {
        value.rate += row[width * k + c] * work.state.v()[width * at(bodies[k]) + c];
        value.acceleration += row[width * k + c] * work.state.a()[width * at(bodies[k]) + c];
      }
    }
  }
}

bool PathFollower::frame(int kinematics, double t, PathPose& pose, FollowedMotion::Work& own,
                         MotionFault& fault) const noexcept {
  for (const PathBridge& bridge : bridges_) {
    if (!bridge.covers(t)) continue;
    bridge.frame(at(kinematics), t, model_.space == Space::spatial, pose);
    return true;
  }
  Work& work = static_cast<Work&>(own);
  if (!reach(t, work, fault)) return false;
  pose_of(kinematics, work, pose);
  return true;
}

void PathFollower::pose_of(int kinematics, const Work& work, PathPose& pose) const noexcept {
  const int marker = model_.kinematics[at(kinematics)].marker;
  const BodyId body = model_.markers[at(marker)].body;
  const Evaluation& e = work.e;
  const MarkerKinematics& k = e.markers[at(marker)];
  double acceleration[6];
  by_space(model_.space, [&]<class Bodies>(Bodies) {
    const double rest[Bodies::velocities] = {};
    const double* a = body == ground ? rest : &work.state.a()[Bodies::velocities * at(body)];
    marker_acceleration(a, e.arms_of<Bodies>()[at(marker)], acceleration);
  });
  for (std::size_t i = 0; i < 3; ++i) pose[i] = {k.position[i], k.velocity[i], acceleration[i]};
  if (model_.space == Space::planar) {
    pose[2] = {system_.markers().angle(marker, work.state.q()), k.angular_velocity[2], acceleration[5]};
    return;
  }
  std::copy_n(k.rotation, 9, pose.turning.rotation.begin());
  std::copy_n(k.angular_velocity, 3, pose.turning.velocity.begin());
  std::copy_n(acceleration + 3, 3, pose.turning.acceleration.begin());
  const std::array<Jet, 3> angles = roll_pitch_yaw_of(pose.turning);
  std::ranges::copy(angles, pose.numbers.begin() + 3);
}

}  // namespace freeplay
