#include "stage/local_error.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double longest_memory = 1.0;  // [s]: the unit of time in which velocities are judged, too
constexpr double least_allowed = std::numeric_limits<double>::min();  // what is less has no digits to compare
}  // namespace

LocalError::LocalError(StageEquations& equations, IndexOneSolver& index_one)
    : equations_(equations), index_one_(index_one) {
  const Layout& layout = equations.system().layout();
  const auto numbers = [](int count) { return std::vector<double>(static_cast<std::size_t>(count)); };
  motion_ = numbers(layout.nv());
  other_a_ = numbers(layout.nv());
  other_lambda_ = numbers(layout.nc());
  most_z_ = other_z_ = other_rate_ = numbers(layout.nz());
  const Joints& joints = equations.system().joints();
  for (int j = 0; j < joints.count(); ++j) {
    // The memory of a contact begins anew with each, and acts as long as it presses.
    if (joints.layout(j).forces != 0 && joints[j].internal.size > 0 && !(joints.layout(j).clearance > 0.0))
      with_memory_.push_back(j);
  }
}

double LocalError::norm(std::span<const double> position, std::span<const double> velocity) {
  if (!(position_ > 0.0)) return 0.0;
  const double in_velocity = part_of_allowed(velocity, velocity_now_);
  const int worst_velocity = worst_component_;
  const double in_position = part_of_allowed(position, position_);
  if (in_position > in_velocity) return in_position;
  worst_component_ = worst_velocity;
  return in_velocity;
}

double LocalError::part_of_allowed(std::span<const double> error, double allowed) {
  const double model_size = equations_.system().size();
  const std::span<const double> unit = equations_.units();
  const bool split = index_one_.part_along_motion(error, motion_);
  const double across_allowed = std::sqrt(allowed * model_size);
  double largest = 0.0;
  worst_component_ = 0;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    // `allowed` is a length: an angle may err by it over the size of the model.
    const double scale = model_size / unit[i], along = split ? motion_[i] : error[i];
    const double part = scale * (std::abs(along) / allowed + std::abs(error[i] - along) / across_allowed);
    if (!(part <= largest)) largest = part, worst_component_ = static_cast<int>(i);
  }
  return largest;
}

double LocalError::internal_norm(double dt, const StateView& end, std::span<const double> error) {
  if (!(position_ > 0.0) || other_z_.empty()) return 0.0;
  // After the variables of the joints come integrals of the energy account, which nothing depends on.
  for (std::size_t i = 0; i < other_z_.size(); ++i) other_z_[i] = end.z[i] + error[i];
  std::ranges::copy(end.a, other_a_.begin());
  std::ranges::copy(end.lambda, other_lambda_.begin());
  StateView other{end.t,         end.q, end.v, std::span(other_a_), std::span(other_lambda_), std::span(other_z_),
                  Span<double>{}};
  const Flows* flows = index_one_.integrate_flows(nullptr);
  const bool solved = index_one_.accelerate(other, std::span(other_rate_));
  index_one_.integrate_flows(flows);
  // No run goes on from a state that a joint refuses.
  if (!solved) return std::numeric_limits<double>::infinity();
  const double model_size = equations_.system().size();
  const std::span<const double> unit = equations_.units();
  double largest = 0.0;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const double part = model_size / unit[i] * dt * std::abs(other_a_[i] - end.a[i]) / velocity_now_;
    if (!(part <= largest)) largest = part, worst_component_ = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < other_z_.size(); ++i) {
    // One that begins to move from zero, as t^3, errs by the same part of itself in first steps of all sizes.
    const double most = most_z_[i];
    if (most > 0.0 && !(std::abs(error[i]) <= internal_allowed * most * std::max(largest, 1.0))) {
      largest = std::abs(error[i]) / (internal_allowed * most), worst_component_ = -1;
    }
  }
  const double idle = part_of_idle(end, error);
  if (idle > largest) largest = idle, worst_component_ = -1;
  return largest;
}

bool LocalError::ask(int joint, int i, const Point& at, Answer& answer) {
  const Joints& joints = equations_.system().joints();
  const Slice& own = joints[joint].internal;
  JointForces forces{};
  forces.internal_rate = {other_rate_.data(), freeplay::at(own.size)};
  std::ranges::fill(forces.internal_rate, 0.0);
  Message refusal;
  if (!joints.handle(joint).apply(joints.input(joint, at, equations_.evaluation()), forces, refusal)) return false;
  std::copy_n(forces.wrench_a, 6, answer.wrenches);
  std::copy_n(forces.wrench_b, 6, answer.wrenches + 6);
  answer.rate = other_rate_[freeplay::at(i)];
  return true;
}

bool LocalError::ask_at(double z, int joint, int i, const Point& at, Answer& answer) {
  double& own = other_z_[freeplay::at(equations_.system().joints()[joint].internal.offset + i)];
  const double before = std::exchange(own, z);
  const bool answered = ask(joint, i, at, answer);
  own = before;
  return answered;
}

double LocalError::part_of_idle(const StateView& end, std::span<const double> error) {
  const double part = position_ / equations_.system().size();
  std::copy_n(end.z.begin(), other_z_.size(), other_z_.begin());
  StateView here = end;
  here.z = Span<double>(other_z_.data(), other_z_.size());
  const Point at = equations_.point_of(here);
  double largest = 0.0;
  for (const int j : with_memory_) {
    const Slice& own = equations_.system().joints()[j].internal;
    for (int i = 0; i < own.size; ++i) {
      const std::size_t k = freeplay::at(own.offset + i);
      double scale = std::max(most_z_[k], std::abs(end.z[k]));
      if (std::abs(error[k]) <= part * scale) continue;
      // Large enough to be seen in wrenches, to either side: one may be that of where it acts.
      const double probe = std::max(part * scale, position_);
      Answer now, more, less;
      if (!ask(j, i, at, now) || !ask_at(end.z[k] + probe, j, i, at, more) || !ask_at(end.z[k] - probe, j, i, at, less))
        continue;
      const bool idle_above = std::ranges::equal(now.wrenches, more.wrenches);
      // Where it moves something, its error is judged by that.
      if (!idle_above && !std::ranges::equal(now.wrenches, less.wrenches)) continue;
      // One that begins to move from zero is compared with what it comes to while it forgets.
      const double decay = std::abs(((idle_above ? more : less).rate - now.rate) / probe);
      scale = std::max(scale, std::abs(now.rate) * std::min(longest_memory, 1.0 / decay));
      if (part * scale >= least_allowed) largest = std::max(largest, std::abs(error[k]) / (part * scale));
    }
  }
  return largest;
}

}  // namespace freeplay
