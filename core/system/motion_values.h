// DriverValues: motions of the drivers at one time, and at the one before.
#pragma once

#include <limits>
#include <vector>

#include "system/motion.h"

namespace freeplay {

struct DriverValues {
  explicit DriverValues(std::size_t drivers) : motion(drivers), other_motion(drivers) {}

  std::vector<TimeValue> motion;  ///< by driver
  double motion_time = never;
  /// Of the time before that one: methods come back to the middle of a step.
  std::vector<TimeValue> other_motion;
  double other_motion_time = never;
  MotionWork motion_work;

  /// Brings `motion` to a time; false with `fault` where a driver has no value.
  bool bring_to(double t, const Motions& motions, MotionFault& fault);

  static constexpr double never = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace freeplay
