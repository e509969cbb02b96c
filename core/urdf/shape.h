// UrdfShape: what a link looks like and what it collides with. Nothing of it is used, but mistakes in it are reported.
#pragma once

#include <string>

#include "urdf/element.h"

namespace freeplay::urdf {

/// Checks the numbers and the spelling in a `visual` or `collision` of `owner`, each at its own place. What is allowed
/// besides (that radii are positive) is left to urdfdom.
void check_shape(XmlElement& xml, const std::string& owner, Messages& messages);
/// Likewise a `material` that stands in the robot itself.
void check_material(XmlElement& xml, Messages& messages);

}  // namespace freeplay::urdf
