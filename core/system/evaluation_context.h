// EvaluationContext: what evaluations of one run share and others do not, so that runs can share the equations of
// motion.
#pragma once

#include <vector>

#include "freeplay/joint.h"
#include "system/profile.h"

namespace freeplay {

/// A sleeping joint: it is not asked for forces while the origin of its second marker stays within `radius` of `from`,
/// both seen from the origin of the first in world axes [m] (Joint::free_distance).
struct Sleep {
  bool now = false;
  double radius = 0.0, from[3] = {};
  bool left = false;  ///< set by evaluations that found it elsewhere, and asked it

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.now, self.radius, self.from, self.left);
  }

  bool holds(const MarkerKinematics& a, const MarkerKinematics& b) const {
    double squared = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double moved = b.position[i] - a.position[i] - from[i];
      squared += moved * moved;
    }
    return squared < radius * radius;
  }
};

/// Not for several threads.
struct EvaluationContext {
  double per_contact = 0.0;     ///< JointInput::per_contact
  Profile* profile = nullptr;   ///< where the time of the run is counted, or null
  std::vector<Sleep> sleeps{};  ///< by joint; a run decides which joints sleep (run/sleeping_joints.h)

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.sleeps);
  }

  bool is_asleep(int joint) const {
    const auto j = static_cast<std::size_t>(joint);
    return j < sleeps.size() && sleeps[j].now;
  }
};

}  // namespace freeplay
