// Angles and whole turns.
#pragma once

#include <cmath>

namespace freeplay {

inline constexpr double whole_turn = 2.0 * M_PI;  ///< [rad]

/// `angle` [rad] less whole turns: from -pi to pi.
inline double without_turns(double angle) { return angle - whole_turn * std::round(angle / whole_turn); }
/// The same without rounding; half a turn keeps its sign.
inline double wrapped(double angle) { return std::remainder(angle, whole_turn); }
/// The same in (-pi, pi].
inline double principal_angle(double angle) {
  const double rest = wrapped(angle);
  return rest <= -M_PI ? rest + whole_turn : rest;
}

/// `angle` and as many whole turns as bring it nearest to `reference` [rad].
inline double nearest_turn(double angle, double reference) {
  return angle + whole_turn * std::round((reference - angle) / whole_turn);
}

}  // namespace freeplay
