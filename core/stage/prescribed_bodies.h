// Bodies whose motion follows from their constraint equations: driven cranks, and what is fixed to them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "system/jacobian.h"

namespace freeplay {

/// A body and the rows that prescribe it, as many as it has velocities: they touch no other body but ground and those
/// before it in the list.
struct PrescribedBody {
  BodyId body = ground;
  std::array<int, 6> rows{};
};

/// Rows marked in `dependent` are left out. A body on which more such rows
/// act is not listed.
std::vector<PrescribedBody> prescribed_bodies(const ConstraintJacobian& jacobian, std::span<const char> dependent);

}  // namespace freeplay
