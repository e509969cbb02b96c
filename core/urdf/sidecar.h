// UrdfSidecar: a model file that adds to a URDF file.
#pragma once

#include "base/diagnostics.h"
#include "format/document.h"

namespace freeplay {

/// Replaces the section `urdf` of a YAML model by what the URDF file says. Bodies and joints of the URDF come first, in
/// its order. Of a body that the URDF declares the model may say `frames`, `pose` and `velocity`, of a revolute joint
/// `clearance`; any other name must be new. False after an error that leaves no model to check.
bool add_robot(Document& document, Diagnostics& diagnostics);

}  // namespace freeplay
