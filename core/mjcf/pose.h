// MjcfPose: where an element of an MJCF file stands, in each of the ways in which it may say so.
#pragma once

#include "mjcf/settings.h"

namespace freeplay::mjcf {

/// `pos` and one of `quat`, `axisangle`, `xyaxes`, `zaxis` and `euler`.
Eigen::Isometry3d read_pose(Element& element, const Settings& settings, Messages& messages);

/// A quaternion w x y z of any length but zero, which is reported at `spot`.
Eigen::Matrix3d turn_of(const double* quaternion, const Spot& spot, const std::string& owner, Messages& messages);

/// The least rotation that takes z to `axis`, which is not zero.
Eigen::Matrix3d turn_to(const Eigen::Vector3d& axis);

}  // namespace freeplay::mjcf
