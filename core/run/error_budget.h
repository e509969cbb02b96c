// ErrorBudget: what steps over short loads may still err by.
#pragma once

#include <algorithm>
#include <cmath>

namespace freeplay {

/// Errors of steps on smooth motion have either sign; beside the corners of a load that comes again and again they have
/// the same one, and an error of velocity grows into one of position until the run ends. So the errors of such steps
/// are summed up as displacements at the end of the run, and each step may spend a part of the budget that is left: the
/// errors of 16 steps at first, and a fixed amount more in each second. Numbers are in units of what a step on smooth
/// motion may err by.
///
/// The run goes on with the better of two results. Its error falls by a power of the step more than the estimate does,
/// that is with the power (p + 1)/p of the estimate: what is spent is that, but for `rough` steps, beside infinite
/// slopes, where both fall alike; these count four times.
class ErrorBudget {
 public:
  /// `gain`: what each second adds. `error_order`: p.
  ErrorBudget(double gain, int error_order) : gain_(gain), power_((error_order + 1.0) / error_order) {}

  /// The estimate that the next step may have, where an error counts `times` as much as that of a short step.
  double share(double times, bool rough) const {
    const double part = left_ / full / times;
    return rough ? part / rough_counts : std::pow(part, 1.0 / power_);
  }
  /// Time goes on [s].
  void pass(double dt) { left_ = std::min(full, left_ + gain_ * dt); }
  /// A step was made, with such a part of its share as its estimate.
  void spend(double part, bool rough) { left_ -= std::pow(std::min(part, 1.0), rough ? 1.0 : power_) * left_ / full; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.left_);
  }

 private:
  static constexpr double full = 16.0, rough_counts = 4.0;
  double gain_, power_, left_ = full;
};

}  // namespace freeplay
