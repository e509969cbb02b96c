// Reach: how far bodies can be from the origin of the world, by the lengths of the model.
#pragma once

#include <vector>

#include "model/model.h"

namespace freeplay {

/// Upper bound of the distance of each body's centre of mass from the world's origin [m]: along the shortest chain of
/// frames and of joints that hold two origins together, or would without their play; of these clearance and smaller
/// radius count, or ten times the clearance. Infinite where no such chain leads to the ground.
[[gnu::cold]] std::vector<double> reach(const Model& model);

}  // namespace freeplay
