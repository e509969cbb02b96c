#include "system/motion_values.h"

#include <utility>

namespace freeplay {

bool DriverValues::bring_to(double t, const Motions& motions, MotionFault& fault) {
  if (motion_time == t) return true;
  std::swap(motion, other_motion);
  std::swap(motion_time, other_motion_time);
  if (motion_time == t) return true;
  motion_time = never;
  if (!motions.evaluate(t, {motion.data(), motion.size()}, motion_work, fault)) return false;
  motion_time = t;
  return true;
}

}  // namespace freeplay
