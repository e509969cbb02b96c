// Planar bodies: (x, y, theta) of the centre of mass, and how markers ride on them.
//
// With s the marker's offset from the centre of mass in world axes, E the quarter turn and w = theta':
//   P = r + s,  P' = r' + E s w,  P'' = r'' + E s w' - s w^2;  twist = J v with J = [1 E s; 0 1].
// This file and its spatial counterpart alone know the coordinates of a body.
#pragma once

#include <cmath>
#include <span>

#include "model/model.h"

namespace freeplay::planar {

inline constexpr int coordinates = 3, velocities = 3;
/// Entries of a twist or wrench that a planar model has: vx vy wz, Fx Fy Mz.
inline constexpr int components[3] = {0, 1, 5};

/// What a marker's place on its body comes to, found once.
struct Mount {
  BodyId body = ground;
  double x = 0.0, y = 0.0;          ///< offset from the centre of mass, body axes [m]
  double cosine = 1.0, sine = 0.0;  ///< of the marker's angle on the body
  double angle = 0.0;               ///< [rad]
};

/// Offset of a marker from its body's centre of mass in world axes [m], the body's angular velocity, and where the
/// marker stands [m].
struct Arm {
  double x = 0.0, y = 0.0, w = 0.0;
  double at_x = 0.0, at_y = 0.0;
};

/// Sine and cosine of a body's angle.
struct Turn {
  double cosine = 1.0, sine = 0.0, angle = 0.0;
};

inline Mount mount(const Model& model, const Marker& marker) {
  Mount m{marker.body, marker.position[0], marker.position[1], std::cos(marker.angle), std::sin(marker.angle),
          marker.angle};
  if (marker.body != ground) {
    const Body& body = model.bodies[static_cast<std::size_t>(marker.body)];
    m.x -= body.com[0];
    m.y -= body.com[1];
  }
  return m;
}

inline void marker_arm(const Mount& m, const double* q, const double* v, const Turn& turn, Arm& arm) {
  const double x = turn.cosine * m.x - turn.sine * m.y, y = turn.sine * m.x + turn.cosine * m.y;
  arm = {x, y, v[2], q[0] + x, q[1] + y};
}

/// Twist of a marker whose arm is known.
inline void marker_velocity(const double* v, const Arm& arm, MarkerKinematics& k) {
  k.velocity[0] = v[0] - arm.y * v[2];
  k.velocity[1] = v[1] + arm.x * v[2];
  k.angular_velocity[2] = v[2];
}

/// Pose and twist of a marker whose arm is known. Entries that a planar motion never changes are left as they are
/// (zero, and 1 in the rotation's last place).
inline void marker_kinematics(const Mount& m, const double* v, const Turn& turn, const Arm& arm, MarkerKinematics& k) {
  k.position[0] = arm.at_x;
  k.position[1] = arm.at_y;
  const double c = turn.cosine * m.cosine - turn.sine * m.sine, s = turn.sine * m.cosine + turn.cosine * m.sine;
  k.rotation[0] = c;
  k.rotation[1] = -s;
  k.rotation[3] = s;
  k.rotation[4] = c;
  marker_velocity(v, arm, k);
}

/// Row g of a marker's twist (6 numbers) as a row of the body's velocities (3 numbers): g J.
inline void body_row(const double* g, const Arm& arm, double* row) {
  row[0] = g[0];
  row[1] = g[1];
  row[2] = g[5] - arm.y * g[0] + arm.x * g[1];
}

/// g J' v: what the marker's acceleration holds besides J a.
inline double velocity_product(const double* g, const Arm& arm) {
  return -(g[0] * arm.x + g[1] * arm.y) * arm.w * arm.w;
}

/// Generalised force J^T W of a wrench (6 numbers) at the marker, added.
inline void add_wrench(const double* wrench, const Arm& arm, double* force) {
  force[0] += wrench[0];
  force[1] += wrench[1];
  force[2] += wrench[5] + arm.x * wrench[1] - arm.y * wrench[0];
}

/// The wrench at the marker that a generalised force of its body is.
inline void wrench_of(const double* force, const Arm& arm, double* wrench) {
  wrench[0] = force[0];
  wrench[1] = force[1];
  wrench[2] = wrench[3] = wrench[4] = 0.0;
  wrench[5] = force[2] - (arm.x * force[1] - arm.y * force[0]);
}

/// J a + J' v: linear and angular acceleration of a marker, 6 numbers.
inline void marker_acceleration(const double* a, const Arm& arm, double* out) {
  out[0] = a[0] - arm.y * a[2] - arm.x * arm.w * arm.w;
  out[1] = a[1] + arm.x * a[2] - arm.y * arm.w * arm.w;
  out[2] = out[3] = out[4] = 0.0;
  out[5] = a[2];
}

/// The types above, for code that serves both spaces.
struct Bodies {
  using Mount = planar::Mount;
  using Turn = planar::Turn;
  using Arm = planar::Arm;
  static constexpr int coordinates = planar::coordinates, velocities = planar::velocities;
};
inline Turn turn(Bodies, const double* q, const double*) { return {std::cos(q[2]), std::sin(q[2]), q[2]}; }

}  // namespace freeplay::planar
