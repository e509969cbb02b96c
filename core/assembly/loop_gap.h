// LoopGap: how far the loops of a mechanism are from closing.
#pragma once

#include <optional>

#include "assembly/closed_mechanism.h"
#include "assembly/joint_miss.h"

namespace freeplay {

/// A joint that stays open while everything else holds.
struct LoopGap {
  int joint = 0;  ///< index into Model::joints
  /// Of bodies from the origin, by the model's size: there a small turn closes any gap.
  static constexpr double far_away = 10.0;
  double size = 0.0;  ///< root of the sum of squares of what its rows miss [m, rad]
  JointMiss miss{};   ///< the same by its units
};

/// Largest distance of a body from the origin of the world, where the mechanism stands [m].
double farthest_body(const ClosedMechanism& mechanism);

/// The smallest opening of one joint with which all other rows of `mechanism` hold, looked for from its state on, where
/// it stays: of the joint whose rows miss most where the sum of squares of all is least. Empty when the other rows do
/// not hold either or a body is far away, as where drivers contradict each other, and in large models.
std::optional<LoopGap> loop_gap(ClosedMechanism& mechanism);

}  // namespace freeplay
