// UrdfInertia: is the inertia that a URDF gives one that a body can have, and what comes nearest if not?
#pragma once

#include "urdf/element.h"

namespace freeplay::urdf {

/// Why no body can have the tensor, or "": "a principal value is negative", "the principal values break the triangle
/// inequality" (by more than 1e-6 of the largest).
std::string fault_of_inertia(const Eigen::Matrix3d& inertia);

/// The nearest possible tensor with principal values that are nowhere smaller, about the same axes: negative ones
/// become 0; then, if the largest exceeds the sum of the others, each of these gets half of what is missing.
Eigen::Matrix3d repaired(const Eigen::Matrix3d& inertia);

/// Judges the inertia of every link with mass that is part of a body. `normal` is the normal of the plane in the root
/// frame of a planar robot: there only the moment about it counts, and it must not be negative; what no body in space
/// can have is a warning. Without (`planar` false) the whole tensor must be possible: `out-of-range`. Mends instead of
/// refusing where the options say so, with a warning for each.
void check_inertia(Robot& robot, const Options& options, bool planar, const Eigen::Vector3d& normal,
                   Messages& messages);

}  // namespace freeplay::urdf
