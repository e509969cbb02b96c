// Spatial bodies: position of the centre of mass and a unit quaternion, and how markers ride on them.
//
// A body's axes here are its principal axes, so that M is diagonal: q = [r; quaternion w x y z of
// world-from-principal], v = [r' in world axes; w in principal axes]. Increments are [dr; rotation vector in principal
// axes]: R <- R exp(d). With s the marker's offset from the centre of mass and w its angular velocity, both in world
// axes:
//   P = r + s,  P' = r' + w x s,  P'' = r'' + w' x s + w x (w x s);  twist = J v with J = [1 -[s]R; 0 R].
// This file, its types in spatial_bodies.h and its planar counterpart alone know the coordinates of a body.
#pragma once

#include <cmath>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "model/model.h"
#include "system/spatial_bodies.h"

namespace freeplay::spatial {

inline Eigen::Map<const Vector> vector(const double* numbers) { return Eigen::Map<const Vector>(numbers); }
inline Eigen::Map<Vector> target(double* numbers) { return Eigen::Map<Vector>(numbers); }

inline Matrix rotation_of(const double* quaternion) {
  const double w = quaternion[0], x = quaternion[1], y = quaternion[2], z = quaternion[3];
  Matrix r;
  r << 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),  //
      2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),   //
      2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y);
  return r;
}

inline void marker_kinematics(const Mount& m, const double* q, const double* v, const Turn& turn, MarkerKinematics& k,
                              Arm& arm) {
  arm.s = turn.rotation * m.position;
  arm.turn = turn;
  target(k.position) = vector(q) + arm.s;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(k.rotation) = turn.rotation * m.rotation;
  target(k.velocity) = vector(v) + turn.w.cross(arm.s);
  target(k.angular_velocity) = turn.w;
}

/// Row g of a marker's twist (6 numbers) as a row of the body's velocities (6 numbers): g J.
inline void body_row(const double* g, const Arm& arm, double* row) {
  target(row) = vector(g);
  target(row + 3) = arm.turn.rotation.transpose() * (vector(g + 3) + arm.s.cross(vector(g)));
}

/// g J' v: what the marker's acceleration holds besides J a.
inline double velocity_product(const double* g, const Arm& arm) {
  return vector(g).dot(arm.turn.w.cross(arm.turn.w.cross(arm.s)));
}

/// Generalised force J^T W of a wrench (6 numbers) at the marker, added.
inline void add_wrench(const double* wrench, const Arm& arm, double* force) {
  target(force) += vector(wrench);
  target(force + 3) += arm.turn.rotation.transpose() * (vector(wrench + 3) + arm.s.cross(vector(wrench)));
}

/// The wrench at the marker that a generalised force of its body is.
inline void wrench_of(const double* force, const Arm& arm, double* wrench) {
  target(wrench) = vector(force);
  target(wrench + 3) = arm.turn.rotation * vector(force + 3) - arm.s.cross(vector(force));
}

/// J a + J' v: linear and angular acceleration of a marker, 6 numbers.
inline void marker_acceleration(const double* a, const Arm& arm, double* out) {
  const Vector alpha = arm.turn.rotation * vector(a + 3);
  target(out) = vector(a) + alpha.cross(arm.s) + arm.turn.w.cross(arm.turn.w.cross(arm.s));
  target(out + 3) = alpha;
}

/// How a marker's pose (6 numbers) and twist (6) change by component `c` of an increment of its body.
inline void by_increment(int c, const Arm& arm, double* pose, double* twist) {
  Eigen::Map<Vector> position(pose), rotation(pose + 3), velocity(twist), angular(twist + 3);
  position.setZero(), rotation.setZero(), velocity.setZero(), angular.setZero();
  if (c < 3) {
    position[c] = 1.0;
    return;
  }
  const Vector u = arm.turn.rotation.col(c - 3), w = arm.turn.w;
  const Vector moved = u.cross(arm.s), turned = u.cross(w);
  position = moved;
  rotation = u;
  velocity = turned.cross(arm.s) + w.cross(moved);
  angular = turned;
}

/// How a marker's twist changes by component `c` of its body's velocities.
inline void by_velocity(int c, const Arm& arm, double* twist) {
  Eigen::Map<Vector> velocity(twist), angular(twist + 3);
  velocity.setZero(), angular.setZero();
  if (c < 3) {
    velocity[c] = 1.0;
    return;
  }
  const Vector u = arm.turn.rotation.col(c - 3);
  velocity = u.cross(arm.s);
  angular = u;
}

/// How J^T W of a fixed wrench changes by component `c` of an increment of its own body, added to `change`.
inline void add_wrench_derivative(int c, const double* wrench, const Arm& arm, double* change) {
  if (c < 3) return;
  const Vector u = arm.turn.rotation.col(c - 3), force = vector(wrench);
  const Vector moment = vector(wrench + 3) + arm.s.cross(force);
  target(change + 3) += arm.turn.rotation.transpose() * (u.cross(arm.s).cross(force) - u.cross(moment));
}

/// Jr^-1(d) w: the rate of the rotation vector d of R = R_0 exp(d) at the angular velocity w, both in body axes.
/// Bottasso and Borri 1998, Comput Methods Appl Mech Eng 164, 307-331.
inline Vector rotation_rate(const Vector& d, const Vector& w) {
  const double angle2 = d.squaredNorm();
  double c = 0.0;  // 1/x^2 - (1 + cos x)/(2 x sin x)
  if (angle2 < 1e-2) {
    c = 1.0 / 12.0 + angle2 * (1.0 / 720.0 + angle2 * (1.0 / 30240.0 + angle2 / 1209600.0));
  } else {
    const double x = std::sqrt(angle2);
    c = 1.0 / angle2 - 0.5 / (x * std::tan(0.5 * x));
  }
  return w + 0.5 * d.cross(w) + c * d.cross(d.cross(w));
}

/// d'' for the rate d' = rotation_rate(d, w) and the angular acceleration w', all in body axes.
inline Vector rotation_acceleration(const Vector& d, const Vector& rate, const Vector& w, const Vector& alpha) {
  const double angle2 = d.squaredNorm();
  double c = 0.0, slope = 0.0;  // c as in rotation_rate() and its derivative by x^2
  if (angle2 < 1e-2) {
    c = 1.0 / 12.0 + angle2 * (1.0 / 720.0 + angle2 * (1.0 / 30240.0 + angle2 / 1209600.0));
    slope = 1.0 / 720.0 + angle2 * (1.0 / 15120.0 + angle2 / 403200.0);
  } else {
    const double x = std::sqrt(angle2), sine = std::sin(0.5 * x), cotangent = std::cos(0.5 * x) / sine;
    c = 1.0 / angle2 - 0.5 * cotangent / x;
    slope = (-2.0 / (angle2 * x) + 0.25 / (x * sine * sine) + 0.5 * cotangent / angle2) / (2.0 * x);
  }
  const Vector turned = d.cross(w);
  return rotation_rate(d, alpha) + 0.5 * rate.cross(w) + c * (rate.cross(turned) + d.cross(rate.cross(w))) +
         2.0 * slope * d.dot(rate) * d.cross(turned);
}

/// Jr(d) d': the angular velocity in body axes, inverse of rotation_rate().
inline Vector angular_velocity(const Vector& d, const Vector& rate) {
  const double angle2 = d.squaredNorm();
  double b = 0.0, c = 0.0;  // (1 - cos x)/x^2, (x - sin x)/x^3
  if (angle2 < 1e-2) {
    b = 0.5 - angle2 * (1.0 / 24.0 - angle2 * (1.0 / 720.0 - angle2 / 40320.0));
    c = 1.0 / 6.0 - angle2 * (1.0 / 120.0 - angle2 * (1.0 / 5040.0 - angle2 / 362880.0));
  } else {
    const double x = std::sqrt(angle2);
    b = (1.0 - std::cos(x)) / angle2;
    c = (x - std::sin(x)) / (angle2 * x);
  }
  return rate - b * d.cross(rate) + c * d.cross(d.cross(rate));
}

/// out = a b for quaternions w x y z; `out` may be one of them.
inline void multiply(const double* a, const double* b, double* out) {
  const double product[4] = {
      a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
      a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
  for (int i = 0; i < 4; ++i) out[i] = product[i];
}

/// Unit quaternion of exp(d).
inline void exponential(const Vector& d, double* quaternion) {
  const double angle2 = d.squaredNorm(), angle = std::sqrt(angle2);
  const double half_sinc = angle2 < 1e-8 ? 0.5 - angle2 / 48.0 : std::sin(0.5 * angle) / angle;
  quaternion[0] = std::cos(0.5 * angle);
  for (int i = 0; i < 3; ++i) quaternion[1 + i] = half_sinc * d[i];
}

/// Rotation vector of a unit quaternion, at most pi long.
inline Vector logarithm(const double* quaternion) {
  const double sign = quaternion[0] < 0.0 ? -1.0 : 1.0;
  const Vector part = sign * vector(quaternion + 1);
  const double sine = part.norm(), cosine = sign * quaternion[0];
  const double factor = sine < 1e-6 ? 2.0 / cosine - 2.0 * sine * sine / (3.0 * cosine * cosine * cosine)
                                    : 2.0 * std::atan2(sine, cosine) / sine;
  return factor * part;
}

/// q <- base + increment, one body. The quaternion is made a unit one again.
inline void retract_body(const double* base, const double* increment, double* q) {
  for (int i = 0; i < 3; ++i) q[i] = base[i] + increment[i];
  double turn[4];
  exponential(vector(increment + 3), turn);
  multiply(base + 3, turn, q + 3);
  double norm = 0.0;
  for (int i = 3; i < 7; ++i) norm += q[i] * q[i];
  norm = std::sqrt(norm);
  for (int i = 3; i < 7; ++i) q[i] /= norm;
}

/// The increment that retract_body() takes from `base` to `q`.
inline void difference_body(const double* base, const double* q, double* increment) {
  for (int i = 0; i < 3; ++i) increment[i] = q[i] - base[i];
  const double back[4] = {base[3], -base[4], -base[5], -base[6]};
  double turn[4];
  multiply(back, q + 3, turn);
  target(increment + 3) = logarithm(turn);
}

inline Turn turn(Bodies, const double* q, const double* v) {
  Turn t;
  t.rotation = rotation_of(q + 3);
  t.w = t.rotation * vector(v + 3);
  return t;
}

}  // namespace freeplay::spatial
