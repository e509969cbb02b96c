// Where a joint was forgotten: frames that nothing uses say so.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "system/system.h"

namespace freeplay {

struct MissedJoint {
  /// By body: whether it is one of a pair, of which one moves, that no joint holds together though a frame which
  /// nothing uses stands on one of them about where a frame of the other does: there a loop was to close. All, where
  /// nothing at all uses a frame of ground or of a body that stands still.
  std::vector<char> bodies;
  std::string frame;  ///< the first such, in words; empty: no body is one of these
};

/// In the closed mechanism as it starts.
MissedJoint missed_joint(const System& closed, const Evaluation& at_start,
                         const std::function<bool(BodyId)>& is_moving);

}  // namespace freeplay
