// RobotFile: a robot in any of the XML formats that are read.
#pragma once

#include "urdf/document.h"

namespace freeplay {

/// The root element says the format: `robot` is URDF, `mujoco` MJCF, `sdf` SDFormat. The rest is as
/// urdf::add_sections() says.
std::optional<urdf::Sections> add_robot_sections(const std::string& text, const std::string* file_name,
                                                 const urdf::Options& options, Document& document,
                                                 Diagnostics& diagnostics);

}  // namespace freeplay
