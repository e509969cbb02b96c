// JointWay: between which ends a joint may stand, by its stops and by what `analysis` says.
#pragma once

#include <span>
#include <vector>

#include "analysis/posture.h"

namespace freeplay {

struct JointWay {
  int joint = 0;                       ///< index into Model::joints
  double lowest = 0.0, highest = 0.0;  ///< of its coordinate [rad or m]
};

/// Of all joints and force elements that declare ends (JointLayout::lowest), and `analysis: {limits}`.
std::vector<JointWay> joint_ways(const Model& model);

/// Does the posture keep to all ways, up to rounding? Angles count up to whole turns. Else `why` says which it leaves.
bool within_ways(std::span<const JointWay> ways, PostureSolver& solver, double t, const Posture& posture,
                 Unreachable& why);

}  // namespace freeplay
