// UrdfSidecar: a model file that adds to a robot file, URDF or another.
#pragma once

#include "base/diagnostics.h"
#include "format/document.h"
#include "urdf/document.h"

namespace freeplay {

/// Reads the text of a robot file, whatever its format, as urdf::add_sections() does.
using RobotReader = std::optional<urdf::Sections> (*)(const std::string& text, const std::string* file_name,
                                                      const urdf::Options& options, Document& document,
                                                      Diagnostics& diagnostics);

/// Replaces the section `urdf` of a YAML model by what the robot file says. Bodies and joints of the URDF come first,
/// in its order. Of a body that the URDF declares the model may say `frames`, `pose` and `velocity`, of a revolute
/// joint `clearance`; any other name must be new. False after an error that leaves no model to check.
bool add_robot(Document& document, RobotReader read, Diagnostics& diagnostics);

}  // namespace freeplay
