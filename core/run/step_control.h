// StepControl: the size of the next step from the error of the last.
#pragma once

namespace freeplay {

struct StepLimits {
  double first, smallest, largest;  ///< [s]
};

/// Proportional-integral control: after an accepted step with the error E (1 is allowed) the next is
///   h 0.9 E^(-0.85/p) E_old^(0.2/p), within [0.2, 5] h, p the power of h with which the error falls (after the first
///   step up to 10^4 h);
/// after a rejected one h 0.9 E^(-1/p), within [0.1, 0.9] h, and the next does not grow. Gustafsson 1991; the exponents
/// are those of Hairer and Wanner 1996, Solving Ordinary Differential Equations II, IV.2, for p = 5.
class StepControl {
 public:
  StepControl(const StepLimits& limits, int error_order) : limits_(limits), power_(error_order), next_(limits.first) {}

  /// Step to try next [s].
  double next() const { return next_; }
  const StepLimits& limits() const { return limits_; }
  void accept(double dt, double error);
  /// The step was made shorter, to end at an event: the proposal stands, and the law of motion may be a new one, of
  /// which the last errors say nothing.
  void cut() { last_error_ = 1.0, rejected_ = false, first_ = false; }
  void reject(double dt, double error);
  /// The step did not converge.
  void halve(double dt);

 private:
  StepLimits limits_;
  double power_, next_, last_error_ = 1.0;
  bool rejected_ = false, first_ = true;
};

}  // namespace freeplay
