// Where paths lead legs to the edge of what they reach.
#pragma once

#include <vector>

#include "system/motion.h"

namespace freeplay {

/// The instants between two times at which the leg of a driver comes close to being stretched or folded. `leg` is that
/// of `driver`, whose path gives the whole pose.
[[gnu::cold]] std::vector<PathEdge> leg_edges(const Model& model, int driver, const Leg& leg, double from, double to);

}  // namespace freeplay
