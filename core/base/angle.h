// Angles and whole turns.
#pragma once

#include <cmath>

namespace freeplay {

inline constexpr double whole_turn = 2.0 * M_PI;  ///< [rad]

/// `angle` [rad] less whole turns: from -pi to pi.
inline double without_turns(double angle) { return angle - whole_turn * std::round(angle / whole_turn); }

}  // namespace freeplay
