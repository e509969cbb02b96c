// Point: where the equations of motion are evaluated, and which of their terms.
#pragma once

#include <span>

#include "system/state.h"

namespace freeplay {

/// Values of the unknowns. Views only.
struct Point {
  double t = 0.0;
  std::span<const double> q, v, z, h;
};
inline Point point(const State& state) { return {state.t(), state.q(), state.v(), state.z(), state.h()}; }

/// Which terms of the equations are wanted.
enum Term : unsigned {
  term_position = 1,      ///< phi and Phi_q
  term_velocity = 2,      ///< nu (with phi)
  term_acceleration = 4,  ///< gamma (with phi)
  term_force = 8,         ///< f
  term_derivative = 16,   ///< derivatives of f (with f)
  term_coordinate = 32,   ///< coordinates of all joints
  term_event = 64,        ///< what JointRef::events() and on_event() read
  term_turn = 256,        ///< coordinates of joints whose turns are counted
};

}  // namespace freeplay
