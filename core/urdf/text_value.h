// UrdfTextValue: values that an element has as its text, as SDFormat writes them.
#pragma once

#include <string>
#include <vector>

#include "urdf/element.h"

namespace freeplay::urdf {

/// The text of an element without blanks at its ends.
std::string trimmed_text(const XmlElement& xml);
/// Where it stands; of the element's name where there is none.
Spot whole_text_spot(const XmlElement& xml);

/// `count` numbers; empty after a message.
std::vector<double> text_numbers(const XmlElement& xml, std::size_t count, Messages& messages);

/// A pose of SDFormat: x y z roll pitch yaw in m and rad, or in degrees by `degrees`, or x y z and a quaternion x y z w
/// by `rotation_format`. Identity where there is no text or after a message.
Eigen::Isometry3d text_pose(const XmlElement& xml, Messages& messages);

}  // namespace freeplay::urdf
