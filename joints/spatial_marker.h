// A marker read in space, and the rows that joints between two markers are made of there.
#pragma once

#include <algorithm>
#include <cmath>

#include "freeplay/eigen.h"

namespace freeplay::space {

using Eigen::Vector3d;

/// Columns of the marker twists [twist a, twist b].
inline constexpr int velocity_a = 0, turn_a = 3, velocity_b = 6, turn_b = 9;

inline Vector3d position(const MarkerKinematics& m) { return vector3(m.position); }
inline Vector3d velocity(const MarkerKinematics& m) { return vector3(m.velocity); }
inline Vector3d angular_velocity(const MarkerKinematics& m) { return vector3(m.angular_velocity); }
/// Axis k of a marker, world axes.
inline Vector3d axis(const MarkerKinematics& m, int k) { return {m.rotation[k], m.rotation[3 + k], m.rotation[6 + k]}; }

inline void write(double* row, int column, const Vector3d& v) {
  for (int i = 0; i < 3; ++i) row[column + i] = v[i];
}
/// A row of the relative angular velocity: r.(w_b - w_a).
inline void write_turn(double* row, const Vector3d& r) {
  write(row, turn_a, -r);
  write(row, turn_b, r);
}
inline double* row_of(const ConstraintRows& rows, int i) { return rows.jacobian.data + 12 * i; }

/// Rows `first` to `first` + 2: P_b - P_a = 0 in world axes, gamma = 0.
inline void join_origins(const JointInput& in, int first, ConstraintRows& rows) {
  for (int i = 0; i < 3; ++i) {
    rows.phi.data[first + i] = in.b->position[i] - in.a->position[i];
    row_of(rows, first + i)[velocity_a + i] = -1.0;
    row_of(rows, first + i)[velocity_b + i] = 1.0;
  }
}

/// The separation of the origins along a unit vector p that is fixed in marker a, d = P_b - P_a [m], w = w_a:
///
///   p.d      (p.d)' = p.d' + (p x d).w      (p.d)'' = p.d'' + (p x d).w' + (w x (w x p)).d + 2 (w x p).d'
class Separation {
 public:
  explicit Separation(const JointInput& in)
      : d_(position(*in.b) - position(*in.a)), rate_(velocity(*in.b) - velocity(*in.a)), w_(angular_velocity(*in.a)) {}

  double along(const Vector3d& p) const { return p.dot(d_); }
  void write_row(const Vector3d& p, double* row) const {
    write(row, velocity_a, -p);
    write(row, velocity_b, p);
    write(row, turn_a, p.cross(d_));
  }
  /// What the second derivative holds beyond the row.
  double bias(const Vector3d& p) const {
    const Vector3d turning = w_.cross(p);
    return w_.cross(turning).dot(d_) + 2.0 * turning.dot(rate_);
  }

  /// Row `index`: p.d = 0.
  void close(const Vector3d& p, int index, ConstraintRows& rows) const {
    rows.phi.data[index] = along(p);
    rows.gamma.data[index] = -bias(p);
    write_row(p, row_of(rows, index));
  }
  void write_coordinate(const Vector3d& p, CoordinateRow& row) const {
    row.value = along(p);
    row.bias = bias(p);
    write_row(p, row.jacobian);
  }

 private:
  Vector3d d_, rate_, w_;
};

/// The product of a unit vector p fixed in marker a and a unit vector q fixed in marker b, w = w_b - w_a:
///
///   p.q      (p.q)' = (q x p).w      (p.q)'' = (q x p).w' + (q x p)'.w
struct Product {
  Product(const JointInput& in, const Vector3d& p, const Vector3d& q)
      : value(p.dot(q)),
        row(q.cross(p)),
        row_rate(angular_velocity(*in.b).cross(q).cross(p) + q.cross(angular_velocity(*in.a).cross(p))) {}
  double value;
  Vector3d row, row_rate;
};

/// Row `index`: p.q = 0.
inline void keep_perpendicular(const JointInput& in, const Vector3d& p, const Vector3d& q, int index,
                               ConstraintRows& rows) {
  const Product product(in, p, q);
  rows.phi.data[index] = product.value;
  rows.gamma.data[index] = -product.row_rate.dot(angular_velocity(*in.b) - angular_velocity(*in.a));
  write_turn(row_of(rows, index), product.row);
}

/// Rows `first` and `first` + 1: the z axes agree, with p = x_a, then y_a:
///
///   2 p.z_b/(1 + z_a.z_b) = 0
///
/// 2 tan(tilt/2) in the direction of p: the tilt in rad where it is small. Unlike p.z_b = 0 it has no second solution
/// with the axes opposite to each other: there, and only there, it is singular.
inline void align_z_axes(const JointInput& in, int first, ConstraintRows& rows) {
  const Vector3d q = axis(*in.b, 2), w = angular_velocity(*in.b) - angular_velocity(*in.a);
  const Product along(in, axis(*in.a, 2), q);
  // Opposite axes: finite, so that the failure is one of convergence.
  const double share = 2.0 / std::max(1.0 + along.value, 1e-12), share_rate = -0.5 * share * share * along.row.dot(w);
  for (int k = 0; k < 2; ++k) {
    const Product across(in, axis(*in.a, k), q);
    const double phi = across.value * share, phi_rate = share * across.row.dot(w) + share_rate * across.value;
    // phi' = r.w with r = share (row of p.z_b) - phi share/2 (row of z_a.z_b)
    const Vector3d row = share * across.row - 0.5 * share * phi * along.row;
    const Vector3d row_rate = share_rate * across.row + share * across.row_rate -
                              0.5 * (share_rate * phi + share * phi_rate) * along.row -
                              0.5 * share * phi * along.row_rate;
    rows.phi.data[first + k] = phi;
    rows.gamma.data[first + k] = -row_rate.dot(w);
    write_turn(row_of(rows, first + k), row);
  }
}

/// Angle of marker b about the z axis of marker a [rad], in (-pi, pi]:
///
///   theta = atan2(y_a.x_b, x_a.x_b)      theta' = u.(w_b - w_a)
///   u = z_a - (m/r^2) n,  m = z_a.x_b,  n = x_b - m z_a,  r^2 = n.n
///
/// u is z_a where the z axes agree; as written the rate is exact everywhere but where x_b stands along z_a.
class AngleAboutZ {
 public:
  explicit AngleAboutZ(const JointInput& in) {
    const Vector3d x_a = axis(*in.a, 0), y_a = axis(*in.a, 1), z = axis(*in.a, 2), x_b = axis(*in.b, 0);
    const Vector3d z_rate = angular_velocity(*in.a).cross(z), x_rate = angular_velocity(*in.b).cross(x_b);
    value = std::atan2(y_a.dot(x_b), x_a.dot(x_b));
    const double m = z.dot(x_b), m_rate = z_rate.dot(x_b) + z.dot(x_rate);
    const Vector3d n = x_b - m * z, n_rate = x_rate - m_rate * z - m * z_rate;
    const double squared = std::max(n.squaredNorm(), 1e-12), squared_rate = 2.0 * n.dot(n_rate);
    row = z - m / squared * n;
    const Vector3d row_rate = z_rate - (m_rate - m * squared_rate / squared) / squared * n - m / squared * n_rate;
    bias = row_rate.dot(angular_velocity(*in.b) - angular_velocity(*in.a));
  }
  void write(CoordinateRow& out) const {
    out.value = value;
    out.bias = bias;
    write_turn(out.jacobian, row);
  }
  double value, bias;
  Vector3d row;
};

}  // namespace freeplay::space
