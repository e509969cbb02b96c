// PathRow: one number of an inverse-kinematics path as a constraint on the body of its frame.
#pragma once

#include <span>
#include <vector>

#include "system/system.h"

namespace freeplay {

/// A number of the path as a row g V of the frame's twist V. In space all three angles together become rows of the
/// rotation vector from the path to the frame, world axes, which has no singular places; single ones are rows of the
/// rates of the angles, which have one where the pitch is a quarter turn.
struct PathRow {
  int kinematics = 0, component = 0, marker = 0;  ///< component: of FramePath
  BodyId body = ground;
  bool whole_turn = false;  ///< a row of the rotation vector

  /// Row of the body's velocities (3 or 6 numbers), at an evaluated point.
  void entries(const System& system, const Evaluation& e, double* row) const;
  /// Position of the frame minus `path`; angles up to whole turns.
  double residual(const System& system, const Point& point, const Evaluation& e, const PathPose& path) const;
  /// Right side of the velocity row.
  double speed(const PathPose& path) const;
  /// Right side of the acceleration row.
  double gamma(const System& system, const Evaluation& e, const PathPose& path) const;

 private:
  bool is_angle_in_space(const System& system) const;
  void twist_row(const System& system, const Evaluation& e, double* g) const;
};

/// Rows of the given numbers of one entry.
std::vector<PathRow> path_rows(const Model& model, int kinematics);

/// The rotation vector in world axes that turns `from` to `to`, each world from frame axes, row-major.
Vector3 turn_between(const double* from, const double* to);

}  // namespace freeplay
