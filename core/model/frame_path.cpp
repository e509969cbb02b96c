#include "model/frame_path.h"

#include <algorithm>

#include "model/path_pose.h"

namespace freeplay {

bool FramePath::gives_any() const {
  for (std::size_t i = 0; i < most_path_numbers; ++i) {
    if (gives(i)) return true;
  }
  return false;
}

bool FramePath::gives_all(std::size_t count) const {
  for (std::size_t i = 0; i < count; ++i) {
    if (!gives(i)) return false;
  }
  return true;
}

bool FramePath::evaluate(double t, PathPose& pose, EvaluationFailure& failure) const noexcept {
  std::array<Jet, most_path_numbers + 1> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (tables[i] != nullptr) {
      if (!tables[i]->evaluate(t, values[i], failure)) return false;
    } else if (i < functions.size() && functions[i]) {
      if (!functions[i]->evaluate(t, values[i], failure)) return false;
    } else {
      continue;
    }
    if (i < most_path_numbers) pose[i] = values[i];
  }
  if (!gives_turning()) return true;
  if (tables[3] == nullptr) {
    pose.turning = turning_of(pose[3], pose[4], pose[5]);
    return true;
  }
  pose.turning = turning_of({values[3], values[4], values[5], values[6]});
  const std::array<Jet, 3> angles = roll_pitch_yaw_of(pose.turning);
  std::copy(angles.begin(), angles.end(), pose.numbers.begin() + 3);
  return true;
}

}  // namespace freeplay
