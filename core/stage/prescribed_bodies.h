// Bodies whose motion follows from their constraint equations: driven cranks, and what is fixed to them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "system/system.h"

namespace freeplay {

/// A body and the rows that prescribe it, as many as it has velocities: they touch no other body but ground and those
/// before it in the list.
struct PrescribedBody {
  BodyId body = ground;
  std::array<int, 6> rows{};
};

/// Found from the pattern of Phi_q, rows marked in `dependent` left out. A body on which more such rows
/// act is not listed.
std::vector<PrescribedBody> prescribed_bodies(const System& system, std::span<const char> dependent);

}  // namespace freeplay
