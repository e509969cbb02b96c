// PathRow: one component of an inverse-kinematics path as a constraint on the body of its frame.
#pragma once

#include <span>
#include <vector>

#include "system/system.h"

namespace freeplay {

/// Component 0, 1: position x, y [m] of the frame; 2: its angle [rad], up to whole turns.
struct PathRow {
  int kinematics = 0, component = 0, marker = 0;
  BodyId body = ground;

  /// Row of the body's three velocities, at an evaluated point.
  void entries(const Evaluation& e, double* row) const;
  /// Position of the frame minus `path`.
  double residual(const System& system, const Point& point, const Evaluation& e, double path) const;
  /// Right side of the acceleration row, for the path's second derivative.
  double gamma(const Evaluation& e, double path_acceleration) const;
};

/// Rows of the given components of one entry.
std::vector<PathRow> path_rows(const Model& model, int kinematics);

}  // namespace freeplay
