#include "run/step_control.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {
constexpr double smallest_error = 1e-8;  // below, the largest growth is reached anyway, and little is learned
constexpr double largest_growth = 5.0;
constexpr double first_growth = 1e4, first_error = 1e-16;  // of the first steps, whose length is arbitrary
constexpr double motionless = 1e-12;                       // an error that is one of rounding
constexpr double broken_power = 3.0;  // after an event forces grow as broken powers: errors fall no faster
}  // namespace

void StepControl::cut(std::uint64_t law) {
  last_error_ = 1.0, rejected_ = false, first_ = broken_ = true;
  auto known = std::ranges::find(laws_, law, &Law::name);
  if (known == laws_.end()) {
    known = std::ranges::min_element(laws_, {}, &Law::used);
    *known = {.name = law};
  }
  known->used = ++events_;
  if (known->first_step > 0.0) next_ = known->first_step;
  law_ = static_cast<std::size_t>(known - laws_.begin());
}

void StepControl::accept(double dt, double error) {
  const double e = std::max(error, smallest_error), judged = first_ ? std::max(error, first_error) : e;
  // A step that something else made shorter than proposed does not hold back the next.
  const double growth = first_ ? first_growth : std::max(largest_growth, next_ / dt);
  double factor = std::clamp(0.9 * std::pow(judged, -proportional_ / power_) * std::pow(last_error_, damping_ / power_),
                             0.2, growth);
  first_ = first_ && error < smallest_error;
  broken_ = false;
  if (rejected_) factor = std::min(factor, 1.0);
  const double proposed = next_;
  next_ = std::min({dt * factor, limits_.largest, error > motionless ? limits_.largest : limits_.uninformed});
  // Between two corners that rounding alone keeps apart no step is too short.
  if (dt < limits_.smallest) next_ = std::max(next_, std::min(proposed, limits_.largest));
  last_error_ = e;
  rejected_ = false;
  if (law_) laws_[*law_].first_step = next_;
  law_.reset();
}

void StepControl::reject(double dt, double error, double most_power) {
  const double power = std::min(broken_ ? std::min(power_, broken_power) : power_, most_power);
  const double factor = std::isfinite(error) ? std::clamp(0.9 * std::pow(error, -1.0 / power), 0.1, 0.9) : 0.1;
  next_ = dt * factor;
  rejected_ = true;
  first_ = false;
}

void StepControl::allow(double times) {
  if (!first_) next_ = std::min(next_ * std::pow(times, 1.0 / power_), limits_.largest);
  last_error_ = std::max(last_error_ / times, smallest_error);
}

void StepControl::halve(double dt) {
  next_ = 0.5 * dt;
  first_ = false;
  rejected_ = true;
}

}  // namespace freeplay
