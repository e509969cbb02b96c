// EvaluationContext: what evaluations of one run share and others do not, so that runs can share the equations of
// motion.
#pragma once

#include <vector>

#include "system/profile.h"
#include "system/sleep.h"

namespace freeplay {

/// Not for several threads.
struct EvaluationContext {
  double per_contact = 0.0;     ///< JointInput::per_contact
  Profile* profile = nullptr;   ///< where the time of the run is counted, or null
  std::vector<Sleep> sleeps{};  ///< by joint, to the last that may; a run decides which (run/sleeping_joints.h)

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
