// Singularity: how near a posture is to places where inputs and platform no longer determine each other.
#pragma once

#include "analysis/velocity_map.h"

namespace freeplay {

/// Below it a singular value or an input's lever counts as zero.
inline constexpr double singular_limit = 1e-6;

/// Type 1 (inverse): a leg is stretched or folded, an input moves nothing. Type 2 (direct): with its inputs held the
/// platform still moves. Gosselin and Angeles 1990.
enum class SingularityKind { none, direct, inverse, both };
const char* word(SingularityKind kind);

/// Of A dX = B dtheta with turns of X times L, all numbers without unit.
struct Singularity {
  double sigma_min = 0.0, sigma_max = 0.0;  ///< extreme singular values of A
  double condition = 0.0;                   ///< their quotient; infinite where sigma_min is zero
  double manipulability = 0.0;              ///< product of all singular values
  double inverse_min = 0.0;                 ///< smallest |B_ii| over the crank's length
  SingularityKind kind = SingularityKind::none;
};

/// `length`: L [m].
Singularity singularity_of(const VelocityMap& map, double length);

}  // namespace freeplay
