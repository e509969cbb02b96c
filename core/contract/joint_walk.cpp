#include "contract/joint_walk.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace freeplay {

void JointWalk::step(const MarkerPair& next, const Twelve& acceleration, double dt) {
  JointMoment trial = now_;
  probe_.begin_step(now_, acceleration, dt, trial);
  trial.t += dt;
  trial.markers = next;
  advance_internal(probe_, trial, dt);
  tried_ = trial;
  handle_events(trial);
  probe_.commit(trial);
  if (probe_.layout().coordinate != Coordinate::none) trial.coordinate = probe_.coordinate(trial).value;
  now_ = trial;
}

// z <- z + (1/dt - dz'/dz)^-1 z'
void advance_internal(const JointProbe& probe, JointMoment& trial, double dt) {
  const auto n = static_cast<Eigen::Index>(trial.z.size());
  if (n == 0) return;
  const auto rate = [&](const JointMoment& there) {
    const std::vector<double> z_rate = probe.forces(there).z_rate;
    Eigen::VectorXd result = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < z_rate.size(); ++i) result[static_cast<Eigen::Index>(i)] = z_rate[i];
    return result;
  };
  const Eigen::VectorXd middle = rate(trial);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n) / dt;
  for (Eigen::Index k = 0; k < n; ++k) {
    JointMoment there = trial;
    // Only the speed of convergence depends on this slope.
    const double small = 1e-6 * std::max(std::abs(trial.z[static_cast<std::size_t>(k)]), 1e-6);
    there.z[static_cast<std::size_t>(k)] += small;
    matrix.col(k) -= (rate(there) - middle) / small;
  }
  const Eigen::VectorXd change = matrix.partialPivLu().solve(middle);
  for (Eigen::Index k = 0; k < n; ++k) trial.z[static_cast<std::size_t>(k)] += change[k];
}

void JointWalk::handle_events(JointMoment& trial) const {
  const Span<const Event> events = probe_.layout().events;
  if (events.empty()) return;
  JointMoment before = now_;
  ProbedEvents start, end;
  const auto look = [&] {
    before.h = trial.h;
    start = probe_.events(before);
    end = probe_.events(trial);
  };
  look();
  // An event may arm another: each is passed on once in a step, in the order of the table.
  for (std::size_t i = 0; i < std::min(start.g.size(), end.g.size()); ++i) {
    const double sign = events[i].crossing == Crossing::rising ? 1.0 : -1.0;
    if (!(sign * start.g[i] <= 0.0 && sign * end.g[i] > 0.0)) continue;
    probe_.on_event(static_cast<int>(i), trial);
    look();
  }
}

ClosedPath::ClosedPath(const JointProbe& probe, RandomNumbers& random) : play_(probe.layout().clearance) {
  Pose pose{};
  const MarkerPair base = random_pair(probe.space(), random);
  start_ = probe.place(0.2, pose) ? placed_pair(base, pose) : distant_pair(base, probe.space(), 0.4, random);
  start_ = with_twists(start_, {});
  if (!(play_ > 0.0)) return;
  for (int i = 0; i < 3; ++i) start_.b.position[i] = start_.a.position[i];
  // Speeds of the order of 1 m/s, as at a contact.
  period_ = 10.0 * play_;
}

Twelve ClosedPath::displacement(double time) const {
  const double s = 2.0 * M_PI * time / period_;
  Twelve by{};
  by[11] = 0.4 * std::sin(s);
  if (play_ > 0.0) {
    const double distance = play_ * (1.0 - 0.02 * std::cos(3.0 * s));
    by[6] = distance * std::cos(s);
    by[7] = distance * std::sin(s);
  } else {
    by[6] = 0.1 * std::sin(s);
    by[7] = 0.1 * std::sin(2.0 * s);
  }
  return by;
}

MarkerPair ClosedPath::at(double time) const {
  const double h = 1e-4 * period_;
  const Twelve before = displacement(time - h), after = displacement(time + h);
  Twelve velocity{};
  for (std::size_t i = 0; i < 12; ++i) velocity[i] = (after[i] - before[i]) / (2.0 * h);
  return with_twists(moved(start_, displacement(time)), velocity);
}

Twelve ClosedPath::acceleration(double time) const {
  const double h = 1e-4 * period_;
  const Twelve before = twists(at(time - h)), after = twists(at(time + h));
  Twelve result{};
  for (std::size_t i = 0; i < 12; ++i) result[i] = (after[i] - before[i]) / (2.0 * h);
  return result;
}

}  // namespace freeplay
