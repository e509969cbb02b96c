// The motion of marker b seen in the axes of marker a, and the way of a force found there back to both markers.
#pragma once

#include "freeplay/kit/dual.h"
#include "rotation_vector.h"

namespace freeplay::space {

/// All in the axes of marker a.
template <class T>
struct RelativeMotion {
  Vec<T> d;         ///< P_b - P_a [m]
  Vec<T> r;         ///< orientation of b in a: what the force needs of it, three numbers
  Vec<T> u;         ///< v_b - v_a [m/s]
  Vec<T> w_a, w_b;  ///< [rad/s]
};

/// In the axes of marker a: force on b, its opposite on a, and the moments on both about their own origins, with
/// moment_a = -(moment_b + d x force).
template <class T>
struct RelativeForce {
  Vec<T> force, moment_a, moment_b;

  /// Adds a force that acts on b at `arm` from its origin, and its opposite on a at the same point.
  void add(const Vec<T>& f, const Vec<T>& arm, const Vec<T>& d) {
    force = force + f;
    moment_a = moment_a - cross(d + arm, f);
    moment_b = moment_b + cross(arm, f);
  }
};

/// A force between two markers that depends on their relative motion alone. Derivatives are exact by forward
/// differentiation in the 15 numbers of the relative motion.
class PairInFirstAxes {
 public:
  /// `r`: see RelativeMotion. `by_turn`: its derivative by a small turn of b against a, world axes.
  PairInFirstAxes(const JointInput& in, const Vector3d& r, const Eigen::Matrix3d& by_turn);
  /// r is axis `k` of b.
  static PairInFirstAxes with_axis(const JointInput& in, int k);
  /// r is the rotation vector of b in a.
  static PairInFirstAxes with_rotation_vector(const JointInput& in);

  RelativeMotion<double> numbers() const {
    const auto at = [this](int i) { return Vec<double>{numbers_[i], numbers_[i + 1], numbers_[i + 2]}; };
    return {at(0), at(3), at(6), at(9), at(12)};
  }
  RelativeMotion<Dual> duals() const;

  /// Rates of the 15 numbers for given accelerations of the markers.
  Dual::Gradient rates(const MarkerAccelerations& acc) const;
  /// Power of the force and its reaction [W].
  double power(const RelativeForce<double>& f) const {
    const RelativeMotion<double> x = numbers();
    return dot(f.force, x.u) + dot(f.moment_b, x.w_b) + dot(f.moment_a, x.w_a);
  }
  const Eigen::Matrix3d& axes() const { return axes_; }

  void write(const RelativeForce<double>& f, JointForces& out) const;
  /// All derivatives of the wrenches; `columns` is the length of a row.
  void write_derivatives(const RelativeForce<Dual>& f, Eigen::Index columns, JointForces& out) const;
  /// Derivatives of the rate of internal variable `index` by the markers; `columns` is the length of a row.
  void write_rate_derivatives(std::size_t index, const Dual& rate, Eigen::Index columns, JointForces& out) const;
  /// Column of internal variable `index`: derivatives of the wrenches by it.
  void write_internal_column(std::size_t index, const RelativeForce<double>& f, Eigen::Index columns,
                             JointForces& out) const;

 private:
  using Inputs = Eigen::Matrix<double, Dual::inputs, 24>;
  using Rows = Eigen::Matrix<double, 3, 24>;

  /// Derivatives of the 15 numbers by [pose a, pose b, twist a, twist b].
  Inputs inputs_by_markers() const;
  /// Derivatives of a vector given in the axes of a, in world axes.
  Rows in_world(const Vec<Dual>& v, const Inputs& inputs) const;

  Eigen::Matrix3d axes_, by_turn_;
  Vector3d d_, u_, w_a_, w_b_;
  Eigen::Matrix<double, Dual::inputs, 1> numbers_;
};

}  // namespace freeplay::space
