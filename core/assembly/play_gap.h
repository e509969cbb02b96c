// Where the parts of a joint with play stand in it.
#pragma once

#include <Eigen/Core>

#include "component/joint_roles.h"
#include "model/model.h"
#include "system/joint_freedom.h"

namespace freeplay {

/// From the origin of the first marker to that of the second, without the way along which the ideal twin is free to
/// slide, world axes [m].
inline Eigen::Vector3d play_gap(const JointElement& joint, Space space, const MarkerKinematics& a,
                                const MarkerKinematics& b) {
  const Eigen::Vector3d apart =
      Eigen::Map<const Eigen::Vector3d>(b.position) - Eigen::Map<const Eigen::Vector3d>(a.position);
  if (plays_between_walls(joint.layout)) {
    const Eigen::Vector3d axis(a.rotation[0], a.rotation[3], a.rotation[6]);
    return apart - axis.dot(apart) * axis;
  }
  if (space == Space::planar || joint.gear >= 0) return apart;
  const JointFreedom freedom = joint_freedom(joint.ideal(), joint.ideal_layout(), a, b);
  return freedom.slides == 1 ? Eigen::Vector3d(apart - freedom.slide.dot(apart) * freedom.slide) : apart;
}

}  // namespace freeplay
