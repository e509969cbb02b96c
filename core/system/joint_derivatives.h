// Derivatives of a joint's wrenches by differences, for joints that do not give their own.
#pragma once

#include <span>

#include "component/joint_ref.h"

namespace freeplay {

/// Fills the planar columns of `derivatives`, laid out as JointForces::derivatives, by central differences of
/// JointRef::apply() in marker space: 12 pairs of calls, two more for each internal variable. `coordinate` says that
/// the joint coordinate follows the markers; `work` holds at least 4 nz numbers. False when the joint fails.
bool difference_forces(const JointRef& joint, const JointInput& input, bool coordinate, std::span<double> derivatives,
                       std::span<double> work, Message& message);

}  // namespace freeplay
