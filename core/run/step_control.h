// StepControl: the size of the next step from the error of the last.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace freeplay {

struct StepLimits {
  double first, smallest, largest;  ///< [s]
  /// Largest after a step that erred by rounding alone, as of a body at rest: it says nothing of forces to come [s].
  double uninformed = std::numeric_limits<double>::infinity();
};

/// Proportional-integral control: after an accepted step with the error E (1 is allowed) the next is
///   h 0.9 E^(-a/p) E_old^(b/p), within [0.2, 5] h, p the power of h with which the error falls (after the first step,
///   and while E stays below 1e-8, up to 10^4 h); a = 0.7, b = 0.4 (Gustafsson 1991), and from p = 5 on, where errors
///   of neighbouring steps are more alike, a = 0.85, b = 0.2 (Hairer and Wanner 1996, Solving Ordinary Differential
///   Equations II, IV.2);
/// after a rejected one h 0.9 E^(-1/p), within [0.1, 0.9] h, and the next does not grow.
class StepControl {
 public:
  StepControl(const StepLimits& limits, int error_order)
      : limits_(limits),
        power_(error_order),
        proportional_(error_order < 5 ? 0.7 : 0.85),
        damping_(error_order < 5 ? 0.4 : 0.2),
        next_(limits.first) {}

  /// Step to try next [s].
  double next() const { return next_; }
  const StepLimits& limits() const { return limits_; }
  void accept(double dt, double error);
  /// The step was made shorter, to end at an event, and the law of motion may be a new one, of which the last errors
  /// say nothing. `law` identifies a law: where it held before, the proposal is what the first step of it would have
  /// been; else the proposal stands. The next step may be far too short (then the one after it grows as after the
  /// first of the run) or far too long (then its error is taken to fall with h^3).
  void cut(std::uint64_t law);
  /// After a kink of what is prescribed the motion is a new one: its steps begin as those of the run did.
  void restart() { next_ = limits_.first, last_error_ = 1.0, rejected_ = false, first_ = true; }
  /// `most_power`: with which its error falls at most.
  void reject(double dt, double error, double most_power = std::numeric_limits<double>::infinity());
  /// From now on errors may be so many times what they might be.
  void allow(double times);
  /// The step did not converge.
  void halve(double dt);

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.laws_, self.law_, self.events_, self.next_, self.last_error_, self.rejected_, self.first_,
            self.broken_);
  }

 private:
  /// A law of motion that began at an event.
  struct Law {
    std::uint64_t name = 0;
    double first_step = 0.0;  ///< that its first error showed to be right; 0: not known
    long used = 0;            ///< events before it began last
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.name, self.first_step, self.used);
    }
  };

  StepLimits limits_;
  std::array<Law, 8> laws_{};
  std::optional<std::size_t> law_;  ///< that began at the end of the last step
  long events_ = 0;
  double power_, proportional_, damping_, next_, last_error_ = 1.0;
  bool rejected_ = false, first_ = true, broken_ = false;
};

}  // namespace freeplay
