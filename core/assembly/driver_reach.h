// Which bodies hang together with those that drivers move.
#pragma once

#include <vector>

#include "model/model.h"

namespace freeplay {

/// By body: whether joints, gears, forces between bodies, or formulas that read the motion of one and act on another
/// tie it to a body of a driven joint, ground left out.
std::vector<char> reached_by_drivers(const Model& model);

}  // namespace freeplay
