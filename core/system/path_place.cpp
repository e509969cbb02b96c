#include "system/path_place.h"

#include <cmath>

#include "base/format_into.h"
#include "base/index.h"
#include "model/path_pose.h"

namespace freeplay {

char* write_place_on_path(const Model& model, int kinematics, double t, char* to, char* end) noexcept {
  const FramePath& path = model.kinematics[at(kinematics)].path;
  PathPose pose;
  EvaluationFailure none;
  if (!path.evaluate(t, pose, none)) return to;
  const std::size_t lengths = model.space == Space::planar ? 2 : 3;
  const char* before = ", where ";
  for (std::size_t i = 0; i < path_numbers(model.space); ++i) {
    // A quaternion has one number more than the turns that come of it, which are given together.
    if (!path.gives(i) || !std::isfinite(pose[i].value)) continue;
    to = format_into(to, end, "{}{} = {:.9g} {}", before, path_words(model.space)[i], pose[i].value,
                     i < lengths ? "m" : "rad");
    before = ", ";
  }
  return to;
}

}  // namespace freeplay
