// ContactStiffness: what a stiffness that a contact law is given says of the material.
#pragma once

#include <optional>
#include <string>

#include "component/parameter_block.h"
#include "freeplay/joint.h"

namespace freeplay {

struct ContactStiffness {
  std::string name, unit;  ///< of the parameter, the unit with its exponent: "N/m^1.5"
  double value = 0.0;
  /// Modulus E* [Pa] of the bodies whose elastic contact has this force, K delta^n = 4/3 E* sqrt(R) delta^1.5: with
  /// R = R_j^2/c at a tenth of the clearance or, where one of them is not known, with the smaller radius or else the
  /// size of the model as R at a thousandth of it.
  double modulus = 0.0;
};

/// Of the contact law in `block`, whose joint has the layout; nothing where K follows from the material. `size` of the
/// model [m]: 0 where it has no lengths.
std::optional<ContactStiffness> given_stiffness(const ParameterBlock& block, const JointLayout& layout, double size);

}  // namespace freeplay
