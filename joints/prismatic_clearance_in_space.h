// The class of `prismatic-clearance` for spatial models; `prismatic_clearance.cpp` has its parameters.
#pragma once

#include "freeplay/plugin.h"

namespace freeplay {

JointFace prismatic_clearance_in_space();

}  // namespace freeplay
