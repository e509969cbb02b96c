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
  /// Modulus E* [Pa] of the bodies whose elastic contact has this force at a tenth of the clearance,
  /// K delta^n = 4/3 E* sqrt(R) delta^1.5 with R = R_j^2/c.
  double modulus = 0.0;
};

/// Of the contact law in `block`, whose joint has the layout; nothing where K follows from the material, or no radii
/// and clearance are known.
std::optional<ContactStiffness> given_stiffness(const ParameterBlock& block, const JointLayout& layout);

}  // namespace freeplay
