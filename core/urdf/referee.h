// UrdfReferee: would urdfdom, the reader that most programs share, take the file?
#pragma once

#include "urdf/element.h"

namespace freeplay::urdf {

/// Hands the links, joints and materials of the robot to urdfdom and reports what it refuses as `bad-urdf`, at the
/// element that it refuses when it stands alone. Numbers are read elsewhere, since urdfdom knows no places; what it
/// would drop in silence has been reported by then.
void ask_referee(const XmlElement& root, Messages& messages);

}  // namespace freeplay::urdf
