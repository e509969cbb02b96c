// JointMiss: how far a joint is from closing, in its two units.
#pragma once

#include <string>
#include <vector>

#include "assembly/closed_mechanism.h"

namespace freeplay {

/// Roots of the sums of squares of what the rows of a joint miss.
struct JointMiss {
  double length = 0.0;  ///< of rows that a shift of a body changes [m]
  double angle = 0.0;   ///< of rows that turns alone change [rad]; in space sines or tangents of small angles
};

/// By row: whether it misses a length, which a shift of a body changes, and not an angle.
std::vector<char> rows_of_lengths(const ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows);

/// Of a joint where `mechanism` stands, whose position rows are `rows`.
JointMiss miss_of(int joint, const ClosedMechanism& mechanism, const ClosedMechanism::Rows& rows);

/// "0.05 m", "120 deg", "0.05 m and 120 deg": what is below `least` [m, rad] or rounding is left out
/// beside the other; lengths with so many digits.
std::string words(const JointMiss& miss, double least, int digits = 6);

}  // namespace freeplay
