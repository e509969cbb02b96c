// The section `drivers`: on one joint, or on several by inverse kinematics.
#pragma once

#include "model/draft.h"

namespace freeplay {

/// Adds the drivers of a part; all joints are known.
void add_drivers(Draft& draft, const Part& part);

}  // namespace freeplay
