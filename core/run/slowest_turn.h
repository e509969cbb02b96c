// SlowestTurn: what a driver turns by gears and belts, and how slowly.
#pragma once

#include "model/model.h"

namespace freeplay {

struct SlowestTurn {
  int joint = 0;       ///< index into Model::joints
  double ratio = 1.0;  ///< by which it turns, of the joint from which it was looked for, without sign
};

/// Of the joints that turn in a fixed ratio with this one, through gears and through strands round wheels that turn on
/// ground, the slowest; the joint itself where none is slower.
[[gnu::cold]] SlowestTurn slowest_turn(const Model& model, int joint);

}  // namespace freeplay
