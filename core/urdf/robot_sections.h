// UrdfRobotSections: what any reader of robot files does once it has a robot.
#pragma once

#include <optional>

#include "urdf/document.h"
#include "urdf/names.h"
#include "urdf/nodes.h"

namespace freeplay::urdf {

/// Chooses the space by options and robot, judges the inertia in it, and writes the sections of the model. `robot` has
/// been through build_tree(). Empty after an error, also one that was reported before.
std::optional<Sections> robot_sections(Robot& robot, Names& names, const Options& options, Nodes& nodes,
                                       Messages& messages);

/// All of it: followers, tree, names, sections. `robot` has its links and joints.
std::optional<Sections> finish_robot(Robot& robot, const Options& options, Nodes& nodes, Messages& messages);

}  // namespace freeplay::urdf
