// UrdfReader: from the elements of a URDF file to a Robot.
#pragma once

#include "urdf/element.h"

namespace freeplay::urdf {

/// Reads links, joints and loops and reports everything in them that is wrong, unknown or not used. The robot is to be
/// trusted only when no error was reported. References are resolved; what hangs where is left to build_tree().
Robot read_robot(const XmlElement& root, Messages& messages);

}  // namespace freeplay::urdf
