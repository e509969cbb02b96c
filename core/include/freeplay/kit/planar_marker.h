// A marker read in the plane: the motion lies in the world xy-plane.
#pragma once

#include <cmath>

#include "freeplay/eigen.h"

namespace freeplay::planar {

/// Columns of the marker twists [twist a, twist b] that a planar row may use.
inline constexpr int velocity_a = 0, turn_a = 5, velocity_b = 6, turn_b = 11;

inline Eigen::Vector2d position(const MarkerKinematics& m) { return {m.position[0], m.position[1]}; }
inline Eigen::Vector2d velocity(const MarkerKinematics& m) { return {m.velocity[0], m.velocity[1]}; }
inline double angular_velocity(const MarkerKinematics& m) { return m.angular_velocity[2]; }
inline Eigen::Vector2d x_axis(const MarkerKinematics& m) { return {m.rotation[0], m.rotation[3]}; }

/// `x` turned by +90 degrees (E x in the equations).
inline Eigen::Vector2d turned(const Eigen::Vector2d& x) { return {-x.y(), x.x()}; }

/// Angle of marker b relative to marker a [rad], in (-pi, pi]; its rate is w_b - w_a everywhere.
inline double relative_angle(const MarkerKinematics& a, const MarkerKinematics& b) {
  const Eigen::Vector2d x_a = x_axis(a), x_b = x_axis(b);
  return std::atan2(turned(x_a).dot(x_b), x_a.dot(x_b));
}

/// The row w_b - w_a of a constraint or a coordinate.
inline void write_turn(double* row) {
  row[turn_a] = -1.0;
  row[turn_b] = 1.0;
}

/// Pose that stands at `x` on the x axis and is turned by `angle`.
inline Pose pose(double x, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{x, 0.0, 0.0}, {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0}};
}

}  // namespace freeplay::planar
