// The class of `revolute-clearance` for spatial models; `revolute_clearance.cpp` has its parameters.
#pragma once

#include "freeplay/plugin.h"

namespace freeplay {

JointFace revolute_clearance_in_space();
/// The same without shoulders, for `cylindrical_clearance.cpp`.
JointFace cylindrical_clearance_in_space();

}  // namespace freeplay
