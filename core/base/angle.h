// Angles and whole turns.
#pragma once

#include <cmath>

namespace freeplay {

/// `angle` [rad] less whole turns: from -pi to pi.
inline double without_turns(double angle) { return angle - 2.0 * M_PI * std::round(angle / (2.0 * M_PI)); }

}  // namespace freeplay
