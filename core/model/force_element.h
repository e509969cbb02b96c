// What acts between two markers and holds nothing, under whichever heading of the file it stands.
#pragma once

#include "model/model.h"

namespace freeplay {

/// An entry of `forces`, or one of `joints` whose type has no rows and no play.
inline bool is_force_element(const JointElement& joint) {
  return joint.is_force || (joint.gear < 0 && !joint.has_play && joint.ideal_layout().constraint_rows == 0);
}

}  // namespace freeplay
