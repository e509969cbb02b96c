// Rows of one joint at given markers, by themselves: for what a joint holds in any mechanism.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "component/joint_ref.h"

namespace freeplay {

/// Twist of the first marker, then of the second, six numbers each.
using JointJacobian = Eigen::Matrix<double, Eigen::Dynamic, 12, Eigen::RowMajor>;

/// Of a joint with `rows` constraint rows; nothing where it fails.
std::optional<JointJacobian> joint_jacobian(const JointRef& joint, int rows, const MarkerKinematics& a,
                                            const MarkerKinematics& b);

}  // namespace freeplay
