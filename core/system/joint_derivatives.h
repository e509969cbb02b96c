// Derivatives of a joint's wrenches by differences, for joints that do not give their own.
#pragma once

#include <span>

#include "component/joint_ref.h"

namespace freeplay {

/// What a joint that is differenced is and what sizes the steps.
struct DifferencedJoint {
  const JointRef& joint;
  const JointLayout& layout;
  double size;  ///< of the model [m]
  /// Numbers that the calls work with: difference_numbers().
  std::span<double> work;
};

/// How many numbers a joint with these internal variables and events needs to work with.
constexpr std::size_t difference_numbers(std::size_t internal, std::size_t events) { return 3 * (internal + events); }

/// Fills `derivatives`, laid out as JointForces::derivatives, by differences of JointRef::apply() in marker space: two
/// calls for each component of pose and twist of both markers and for each internal variable. `here`: what apply()
/// gives at `input`.
///
/// With L = the clearance or, without one, the distance of the markers and at least a hundredth of the model's size,
/// V = the relative speed and at least 1 mm/s, steps are 6e-6 (cube root of the rounding unit, where central
/// differences err least) of L and V, of L over the size of the model for angles; and no less than what rounding of
/// large coordinates needs. A difference does not reach across the zero of one of the joint's event functions, beyond
/// which other forces act: it is then one-sided, from the side on which the joint stands. False when the joint fails.
bool difference_forces(const DifferencedJoint& differenced, const JointInput& input, const JointForces& here,
                       std::span<double> derivatives, Message& message);

}  // namespace freeplay
