// The sides of a loop that does not close.
#pragma once

#include <string>

#include "model/model.h"

namespace freeplay {

/// "; the sides of its loop are 'crank' 0.05 m, 'rod' 0.12 m and ground 0.5 m, and ground is longer than the others
/// together": of the shortest loop through a joint, from joint to joint on each body, and whether it can close where
/// all of its joints hold two points together. Empty without a loop, and for one of many sides.
std::string sides_of_loop(const Model& model, int joint);

}  // namespace freeplay
