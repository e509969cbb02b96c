#include "run/small_difference.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "component/joint_roles.h"
#include "run/body_groups.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

constexpr int most_steps = 3000, steps_per_projection = 16;
constexpr double neighbour = 1e-5;       // distance at which it is evaluated, of the model's size
constexpr double least_freedom = 1e-3;   // of a difference that is left on the constraints
constexpr double of_fixed_steps = 1e-5;  // errors of a run, of the model's size
constexpr double irregular = 3.0;        // mean exponential growth: clearly more than that of regular motions

// Steps, by the time in which differences swing.
constexpr double wanted = 0.4, longest = 1.0;
constexpr double far_longer = 4.0;       // than the step before, which says nothing of it
constexpr int most_long_steps = 4;       // in a row
constexpr double shown_slower = 1.2;     // from one such time to the next, as the shortest shows now and then
constexpr double no_time_before = 1e6;   // of the longest
constexpr double shortest_step = 1e-12;  // of the time

bool can_touch(const Model& model) {
  return std::ranges::any_of(model.joints, [](const JointElement& joint) {
    for (std::size_t i = 0; i < joint.layout.events.size; ++i) {
      if (event_role(joint.layout, i) == EventRole::contact_begin) return true;
    }
    return false;
  });
}

double error_of(const Settings& settings, double size) {
  if (settings.accuracy > 0.0) return settings.accuracy / size;
  return settings.adaptive ? settings.tolerance : of_fixed_steps;
}

}  // namespace

SmallDifference::SmallDifference(const System& system)
    : system_(system),
      first_(error_of(system.model().settings, system.size())),
      grown_(system.model().bodies.size(), 0.0) {
  const Layout& layout = system.layout();
  if (layout.nv() == 0 || can_touch(system.model())) return;
  solver_ = std::make_unique<NewtonStageSolver>(system, ConvergenceParameters{});
  shadow_ = State(layout, 0);
  const BodyGroups groups(system.model());
  for (int i = 0; i < layout.nv(); ++i) {
    group_.push_back(groups.of_body(layout.body_at(i / layout.body_velocities())));
    unit_.push_back(system.coordinates().is_turn(i) ? 1.0 : system.size());
  }
  for (std::vector<double>* list : {&change_, &rate_, &acceleration_, &previous_, &older_, &expected_})
    list->resize(unit_.size());
  size_.resize(grown_.size());
  growth_.resize(grown_.size());
  z_rate_.resize(at(layout.nz()));
  left_ = most_steps;
  due_ = system.model().settings.start;
}

void SmallDifference::follow(const State& accepted) {
  const double t = accepted.t(), dt = t - time_;
  if (left_ == most_steps) {
    if (!begin(accepted)) return stop();
  } else {
    if (!(dt > shortest_step * std::abs(t))) return;
    if (!step(accepted, dt)) return stop();
    measure();
    if (long_steps_ == 0) grow(t, dt);
    scale();
  }
  --left_;
  time_ = t;
  due_ = t + wanted * swing_now_;
}

// Any difference has a part of the one that grows most: these have parts of every motion that is left.
bool SmallDifference::begin(const State& accepted) {
  for (std::size_t i = 0; i < change_.size(); ++i) {
    double whole = 0.0;
    change_[i] = unit_[i] * (0.5 + std::modf(0.618 * static_cast<double>(i + 1), &whole));
  }
  start_ = accepted.t();
  longest_ = swing_ = swing_now_ = system_.model().settings.end - start_;
  measure();
  scale();
  // Redundant rows contradict each other beside the motion.
  if (!differ(accepted) || solver_->rows().any_dependent()) return false;
  swing_ = swing_now_;
  forget();
  measure();
  const bool free = std::ranges::any_of(size_, [](double size) { return size > least_freedom; });
  scale();
  return free;
}

// By polynomials through accelerations at times before, as Adams, Bashforth and Moulton: a predictor of the third
// order, a corrector of the fourth, each with accelerations found anew: without those of the corrector damped springs
// would make it unstable.
bool SmallDifference::step(const State& accepted, double dt) {
  if (dt > far_longer * passed_[0]) forget();
  const double before = passed_[0], span = passed_[0] + passed_[1];
  const double h = dt, hh = h * h;
  for (std::size_t i = 0; i < change_.size(); ++i) {
    const double first = (acceleration_[i] - previous_[i]) / before;
    const double second = (first - (previous_[i] - older_[i]) / passed_[1]) / span;
    change_[i] +=
        h * rate_[i] + hh * (0.5 * acceleration_[i] + h * first / 6.0 + h * (h / 12.0 + before / 6.0) * second);
    rate_[i] += h * acceleration_[i] + hh * (0.5 * first + (h / 3.0 + 0.5 * before) * second);
    older_[i] = previous_[i];
    previous_[i] = acceleration_[i];
    expected_[i] = acceleration_[i] + h * (first + (h + before) * second);
  }
  if (!differ(accepted)) return false;
  // Stiff forces that begin at the end of a step say nothing of it. Where all steps go over their swings the method
  // would be unstable.
  if (dt > longest * swing_now_) {
    forget();
    return ++long_steps_ < most_long_steps;
  }
  long_steps_ = 0;
  const double all = h * (h + before) * (h + span);
  const double of_rate = hh * (0.25 * hh + (before + span) * h / 3.0 + 0.5 * before * span) / all;
  const double of_change = hh * h * (0.05 * hh + (before + span) * h / 12.0 + before * span / 6.0) / all;
  for (std::size_t i = 0; i < change_.size(); ++i) {
    const double missed = acceleration_[i] - expected_[i];
    change_[i] += of_change * missed;
    rate_[i] += of_rate * missed;
  }
  passed_ = {dt, before};
  return differ(accepted);
}

// Nothing is known of times before.
void SmallDifference::forget() {
  previous_ = older_ = acceleration_;
  passed_ = {no_time_before * longest_, no_time_before * longest_};
}

// The neighbour is moved onto the constraints, which it leaves slowly, and its accelerations are those of the equations
// there.
bool SmallDifference::differ(const State& accepted) {
  shadow_.assign_motion(accepted);
  to_body_axes(accepted);
  for (double& change : change_) change *= neighbour;
  system_.coordinates().retract(accepted.q(), change_, shadow_.q());
  for (std::size_t i = 0; i < rate_.size(); ++i) shadow_.v()[i] += neighbour * rate_[i];
  StateView view = shadow_.view();
  solver_->use_history(shadow_.h());
  solver_->move_away();
  const bool project = left_ % steps_per_projection == 0;
  if (project && (!solver_->project_position(view) || !solver_->project_velocity(view))) return false;
  if (!solver_->accelerate(view, {z_rate_.data(), z_rate_.size()})) return false;
  system_.coordinates().difference(accepted.q(), shadow_.q(), change_);
  for (std::size_t i = 0; i < change_.size(); ++i) {
    change_[i] /= neighbour;
    rate_[i] = (shadow_.v()[i] - accepted.v()[i]) / neighbour;
    acceleration_[i] = (shadow_.a()[i] - accepted.a()[i]) / neighbour;
  }
  to_world_axes(accepted);
  double differs = 0.0, by = 0.0, rates = 0.0;
  for (std::size_t i = 0; i < change_.size(); ++i) {
    differs = std::max(differs, std::abs(acceleration_[i] / unit_[i]));
    rates = std::max(rates, std::abs(rate_[i] / unit_[i]));
    by = std::max(by, std::abs(change_[i] / unit_[i]));
  }
  // The time 1 / w with w^2 of the changes and w of their rates as large as the accelerations.
  const double swing =
      differs > 0.0 ? 0.5 * (rates + std::sqrt(rates * rates + 4.0 * by * differs)) / differs : longest_;
  swing_now_ = std::min({swing, shown_slower * swing_now_, longest_});
  return std::isfinite(differs);
}

// Body axes turn, by w: there the rate of a small rotation d is w' - w x d, and in world axes R w' alone.
void SmallDifference::to_body_axes(const State& accepted) {
  if (system_.model().space == Space::planar) return;
  for (std::size_t b = 0; b < change_.size() / 6; ++b) {
    const spatial::Matrix back = spatial::rotation_of(accepted.q().data() + 7 * b + 3).transpose();
    for (std::vector<double>* list : {&change_, &rate_}) {
      const spatial::Vector turned = back * spatial::vector(&(*list)[6 * b + 3]);
      spatial::target(&(*list)[6 * b + 3]) = turned;
    }
  }
}

void SmallDifference::to_world_axes(const State& accepted) {
  if (system_.model().space == Space::planar) return;
  for (std::size_t b = 0; b < change_.size() / 6; ++b) {
    const std::size_t i = 6 * b + 3;
    const spatial::Matrix rotation = spatial::rotation_of(accepted.q().data() + 7 * b + 3);
    const spatial::Vector w = spatial::vector(accepted.v().data() + i), rate = spatial::vector(&rate_[i]);
    const spatial::Vector change = rotation * spatial::vector(&change_[i]), turned = rotation * rate;
    const spatial::Vector acceleration = rotation * (w.cross(rate) + spatial::vector(&acceleration_[i]));
    spatial::target(&change_[i]) = change;
    spatial::target(&rate_[i]) = turned;
    spatial::target(&acceleration_[i]) = acceleration;
  }
}

// Distance of each group.
void SmallDifference::measure() {
  std::ranges::fill(size_, 0.0);
  for (std::size_t i = 0; i < change_.size(); ++i) {
    size_[at(group_[i])] += std::pow(change_[i] / unit_[i], 2) + std::pow(swing_ * rate_[i] / unit_[i], 2);
  }
  for (double& size : size_) size = std::sqrt(size);
}

void SmallDifference::scale() {
  for (std::size_t i = 0; i < change_.size(); ++i) {
    const double size = size_[at(group_[i])];
    if (!(size > 0.0)) continue;
    for (std::vector<double>* list : {&change_, &rate_, &acceleration_, &previous_, &older_}) (*list)[i] /= size;
  }
}

void SmallDifference::grow(double t, double dt) {
  const double passed = t - start_;
  bool over = true;
  for (std::size_t g = 0; g < growth_.size(); ++g) {
    if (!(size_[g] > 0.0)) continue;
    Growth& growth = growth_[g];
    growth.weighted += std::log(size_[g]) * (passed - 0.5 * dt);
    growth.summed += 2.0 * growth.weighted / passed * dt;
    const double mean = growth.summed / passed;
    if (mean > irregular) grown_[g] = std::max(grown_[g], std::min(1.0, first_ * std::exp(2.0 * (mean - 1.0))));
    over = over && grown_[g] >= 1.0;
  }
  if (over) left_ = 1;
}

}  // namespace freeplay
