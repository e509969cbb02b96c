// In which turn a force about an angle starts.
#pragma once

#include <span>

#include "model/model.h"

namespace freeplay {

/// Start angle [rad] of a joint or force that has one: that of a force in the turn in which a joint between the same
/// two bodies counts it, any other as it stands in `coordinate` [rad or m], by joint.
double start_angle(const Model& model, std::span<const double> coordinate, int element);

}  // namespace freeplay
