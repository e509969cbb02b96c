// Ringing: how far a value swings from step to step.
#pragma once

#include <algorithm>
#include <cmath>

namespace freeplay {

/// Follows the turning points of a value that is seen at the ends of steps. Half the way from one to the next is the
/// amplitude of a swing; of two swings in a row the smaller one counts, and only where each takes few steps, as the
/// steps of an integrator with error control are for the fastest motion that it follows.
class Ringing {
 public:
  static constexpr int most_steps = 16;  ///< from one turning point to the next

  void see(double value) {
    const double by = value - last_;
    last_ = value;
    ++steps_;
    if (by * direction_ < 0.0) turn(value - by);
    if (by != 0.0) direction_ = by;
  }
  /// What comes is not what went before.
  void restart(double value) {
    last_ = turning_point_ = value;
    direction_ = swing_ = 0.0;
    steps_ = 0;
  }
  double largest() const { return largest_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.last_, self.direction_, self.turning_point_, self.swing_, self.largest_, self.steps_);
  }

 private:
  void turn(double here) {
    const double swing = steps_ - 1 <= most_steps ? 0.5 * std::abs(here - turning_point_) : 0.0;
    largest_ = std::max(largest_, std::min(swing, swing_));
    swing_ = swing, turning_point_ = here;
    steps_ = 1;
  }

  double last_ = 0.0, direction_ = 0.0;  ///< direction: of the last change
  double turning_point_ = 0.0, swing_ = 0.0, largest_ = 0.0;
  int steps_ = 0;  ///< since the turning point
};

}  // namespace freeplay
