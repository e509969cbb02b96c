// UrdfTree: which link hangs on which, and which of them are bodies.
#pragma once

#include "urdf/element.h"

namespace freeplay::urdf {

/// Fills root, parent_joint, order and mounts of `robot`; with `two_parents` marks the later joints to a link as loops.
/// Reports second parents, cycles, second roots and links without mass that move.
///
/// A root that is named `world` or `ground` or has no mass is ground. A link on a fixed joint is part of what carries
/// it when it has no mass, or when fixed joints are to be merged.
void build_tree(Robot& robot, const Options& options, Messages& messages);

}  // namespace freeplay::urdf
