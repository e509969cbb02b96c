// Which bodies hang together with those that drivers move.
#pragma once

#include <vector>

#include "model/model.h"

namespace freeplay {

/// By body: the number of its group. Joints, gears, forces between bodies, and formulas that read the motion of one and
/// act on another tie bodies to each other, ground left out.
std::vector<int> tied_groups(const Model& model);

/// By body: whether its group has a body of a driven joint.
std::vector<char> reached_by_drivers(const Model& model);

}  // namespace freeplay
