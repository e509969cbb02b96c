// UrdfReader: from the elements of a URDF file to a Robot.
#pragma once

#include "urdf/urdfdom_model.h"

namespace freeplay::urdf {

/// Takes links and joints from `model`, reads loops, and reports everything that is wrong, unknown or not used. The
/// robot is to be trusted only when no error was reported. References are resolved; what hangs where is left to
/// build_tree(). Numbers that are missing or none are replaced by guesses in the document.
Robot read_robot(XmlElement& root, UrdfdomModel& model, Messages& messages);

}  // namespace freeplay::urdf
