// RotationVector: three numbers for the orientation of one marker in another.
#pragma once

#include <cmath>

#include "spatial_marker.h"

namespace freeplay::space {

inline Eigen::Matrix3d cross_matrix(const Vector3d& x) {
  Eigen::Matrix3d m;
  m << 0.0, -x.z(), x.y(), x.z(), 0.0, -x.x(), -x.y(), x.x(), 0.0;
  return m;
}

/// kappa(theta) = 1/theta^2 - cot(theta/2)/(2 theta), and its derivative divided by theta.
struct Kappa {
  explicit Kappa(double theta) {
    const double square = theta * theta;
    if (theta < 0.5) {  // the closed forms lose their digits
      constexpr double c[] = {1.0 / 12.0,         1.0 / 720.0,      1.0 / 30240.0,
                              1.0 / 1209600.0,    1.0 / 47900160.0, 691.0 / 1307674368000.0,
                              1.0 / 74724249600.0};
      value = slope = 0.0;
      for (int k = 6; k >= 0; --k) value = value * square + c[k];
      for (int k = 6; k >= 1; --k) slope = slope * square + 2.0 * k * c[k];
      return;
    }
    const double half = 0.5 * theta, cotangent = std::cos(half) / std::sin(half);
    value = (1.0 - half * cotangent) / square;
    slope = ((0.25 * theta * (1.0 + cotangent * cotangent) - 0.5 * cotangent) - 2.0 * theta * value) / (square * theta);
  }
  double value, slope;
};

/// Orientation of marker b in marker a as rho = axis times angle [rad], |rho| <= pi, in the axes of marker a (and of b:
/// they are the same three numbers). With w = R_a^T (w_b - w_a) the relative angular velocity in the axes of a:
///
///   rho' = L w,  L = 1 - [rho]/2 + kappa [rho]^2,  kappa = 1/theta^2 - cot(theta/2)/(2 theta),  theta = |rho|
///
/// Zero only where the markers are parallel, smooth below half a turn; at half a turn rho changes its sign. Turned
/// about z alone: (0, 0, angle). Shuster 1993, J Astronaut Sci 41, 439-517.
class RotationVector {
 public:
  explicit RotationVector(const JointInput& in) {
    const Eigen::Matrix3d relative = rotation(*in.a).transpose() * rotation(*in.b);
    Eigen::Quaterniond q(relative);
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    const double sine = q.vec().norm();
    // sin(theta/2) of 1e-8: theta/sin is 2 to rounding.
    value = q.vec() * (sine > 1e-8 ? 2.0 * std::atan2(sine, q.w()) / sine : 2.0);
  }

  /// L.
  Eigen::Matrix3d rate_matrix() const {
    const Eigen::Matrix3d x = cross_matrix(value);
    return Eigen::Matrix3d::Identity() - 0.5 * x + Kappa(value.norm()).value * (x * x);
  }
  /// L' for the rate rho'.
  Eigen::Matrix3d rate_matrix_rate(const Vector3d& rate) const {
    const Kappa kappa(value.norm());
    const Eigen::Matrix3d x = cross_matrix(value), y = cross_matrix(rate);
    return -0.5 * y + kappa.slope * value.dot(rate) * (x * x) + kappa.value * (y * x + x * y);
  }

  /// Rows `first` to `first` + 2: rho = 0.
  void close(const JointInput& in, int first, ConstraintRows& rows) const {
    const Eigen::Matrix3d to_a = rotation(*in.a).transpose(), matrix = rate_matrix();
    const Vector3d w_a = angular_velocity(*in.a), w = angular_velocity(*in.b) - w_a, w_in_a = to_a * w;
    const Eigen::Matrix3d rows_of_turn = matrix * to_a;
    // rho'' = L (R_a^T (w_b' - w_a') - R_a^T (w_a x w)) + L' w
    const Vector3d beyond = rate_matrix_rate(matrix * w_in_a) * w_in_a - rows_of_turn * w_a.cross(w);
    for (int i = 0; i < 3; ++i) {
      rows.phi.data[first + i] = value[i];
      rows.gamma.data[first + i] = -beyond[i];
      write_turn(row_of(rows, first + i), rows_of_turn.row(i));
    }
  }

  Vector3d value;
};

}  // namespace freeplay::space
