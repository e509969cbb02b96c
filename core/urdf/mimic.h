// UrdfMimic: joints that follow others.
#pragma once

#include "urdf/element.h"

namespace freeplay::urdf {

/// Finds the leader of each joint that mimics one. Reports unknown leaders, joints without a coordinate, and cycles.
void resolve_mimics(Robot& robot, Messages& messages);

}  // namespace freeplay::urdf
