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
  PairInFirstAxes(const JointInput& in, const Vector3d& r, const Eigen::Matrix3d& by_turn)
      : axes_(rotation(*in.a)),
        by_turn_(by_turn),
        d_(position(*in.b) - position(*in.a)),
        u_(velocity(*in.b) - velocity(*in.a)),
        w_a_(angular_velocity(*in.a)),
        w_b_(angular_velocity(*in.b)) {
    const Eigen::Matrix3d to_a = axes_.transpose();
    numbers_ << to_a * d_, r, to_a * u_, to_a * w_a_, to_a * w_b_;
  }
  /// r is axis `k` of b.
  static PairInFirstAxes with_axis(const JointInput& in, int k) {
    const Vector3d world = axis(*in.b, k);
    const Eigen::Matrix3d to_a = rotation(*in.a).transpose();
    return {in, to_a * world, -to_a * cross_matrix(world)};
  }
  /// r is the rotation vector of b in a.
  static PairInFirstAxes with_rotation_vector(const JointInput& in) {
    const RotationVector rho(in);
    return {in, rho.value, rho.rate_matrix() * rotation(*in.a).transpose()};
  }

  RelativeMotion<double> numbers() const {
    const auto at = [this](int i) { return Vec<double>{numbers_[i], numbers_[i + 1], numbers_[i + 2]}; };
    return {at(0), at(3), at(6), at(9), at(12)};
  }
  RelativeMotion<Dual> duals() const {
    const auto one = [this](int i) { return Dual(numbers_[i], Dual::Gradient::Unit(i)); };
    const auto at = [&](int i) { return Vec<Dual>{one(i), one(i + 1), one(i + 2)}; };
    return {at(0), at(3), at(6), at(9), at(12)};
  }

  /// Rates of the 15 numbers for given accelerations of the markers.
  Dual::Gradient rates(const MarkerAccelerations& acc) const {
    const Eigen::Matrix3d to_a = axes_.transpose();
    using Input = Eigen::Map<const Vector3d>;
    const Vector3d u_rate = Input(acc.b) - Input(acc.a);
    Dual::Gradient rates;
    rates << to_a * (u_ - w_a_.cross(d_)), by_turn_ * (w_b_ - w_a_), to_a * (u_rate - w_a_.cross(u_)),
        to_a * Input(acc.a + 3), to_a * (Input(acc.b + 3) - w_a_.cross(w_b_));
    return rates;
  }
  /// Power of the force and its reaction [W].
  double power(const RelativeForce<double>& f) const {
    const RelativeMotion<double> x = numbers();
    return dot(f.force, x.u) + dot(f.moment_b, x.w_b) + dot(f.moment_a, x.w_a);
  }
  const Eigen::Matrix3d& axes() const { return axes_; }

  void write(const RelativeForce<double>& f, JointForces& out) const {
    const auto in_world = [this](const Vec<double>& v) { return Vector3d(axes_ * Vector3d(v.x, v.y, v.z)); };
    const Vector3d force = in_world(f.force), moment_a = in_world(f.moment_a), moment_b = in_world(f.moment_b);
    for (int i = 0; i < 3; ++i) {
      out.wrench_a[i] = -force[i];
      out.wrench_b[i] = force[i];
      out.wrench_a[3 + i] = moment_a[i];
      out.wrench_b[3 + i] = moment_b[i];
    }
  }

  /// All derivatives of the wrenches; `columns` is the length of a row.
  void write_derivatives(const RelativeForce<Dual>& f, Eigen::Index columns, JointForces& out) const {
    const Inputs inputs = inputs_by_markers();
    const Rows by_force = in_world(f.force, inputs);
    using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<Table> table(out.derivatives.data, 12, columns);
    table.block<3, 24>(0, 0) = -by_force;
    table.block<3, 24>(3, 0) = in_world(f.moment_a, inputs);
    table.block<3, 24>(6, 0) = by_force;
    table.block<3, 24>(9, 0) = in_world(f.moment_b, inputs);
  }
  /// Derivatives of the rate of internal variable `index` by the markers; `columns` is the length of a row.
  void write_rate_derivatives(std::size_t index, const Dual& rate, Eigen::Index columns, JointForces& out) const {
    Eigen::Map<Eigen::Matrix<double, 1, 24>>(out.derivatives.data + (12 + index) * static_cast<std::size_t>(columns)) =
        rate.gradient.transpose() * inputs_by_markers();
  }
  /// Column of internal variable `index`: derivatives of the wrenches by it.
  void write_internal_column(std::size_t index, const RelativeForce<double>& f, Eigen::Index columns,
                             JointForces& out) const {
    JointForces part{};
    write(f, part);
    for (std::size_t i = 0; i < 6; ++i) {
      out.derivatives[i * static_cast<std::size_t>(columns) + 24 + index] = part.wrench_a[i];
      out.derivatives[(6 + i) * static_cast<std::size_t>(columns) + 24 + index] = part.wrench_b[i];
    }
  }

 private:
  using Inputs = Eigen::Matrix<double, Dual::inputs, 24>;
  using Rows = Eigen::Matrix<double, 3, 24>;

  /// Derivatives of the 15 numbers by [pose a, pose b, twist a, twist b].
  Inputs inputs_by_markers() const {
    const Eigen::Matrix3d to_a = axes_.transpose();
    Inputs t = Inputs::Zero();
    // A turn of a carries its axes along: d(R_a^T x) = R_a^T [x] turn.
    t.block<3, 3>(0, 0) = -to_a;
    t.block<3, 3>(0, 3) = to_a * cross_matrix(d_);
    t.block<3, 3>(0, 6) = to_a;
    t.block<3, 3>(3, 3) = -by_turn_;
    t.block<3, 3>(3, 9) = by_turn_;
    t.block<3, 3>(6, 3) = to_a * cross_matrix(u_);
    t.block<3, 3>(6, 12) = -to_a;
    t.block<3, 3>(6, 18) = to_a;
    t.block<3, 3>(9, 3) = to_a * cross_matrix(w_a_);
    t.block<3, 3>(9, 15) = to_a;
    t.block<3, 3>(12, 3) = to_a * cross_matrix(w_b_);
    t.block<3, 3>(12, 21) = to_a;
    return t;
  }
  /// Derivatives of a vector given in the axes of a, in world axes.
  Rows in_world(const Vec<Dual>& v, const Inputs& inputs) const {
    Eigen::Matrix<double, 3, Dual::inputs> gradient;
    gradient << v.x.gradient.transpose(), v.y.gradient.transpose(), v.z.gradient.transpose();
    Rows rows = axes_ * (gradient * inputs);
    rows.middleCols<3>(3) -= cross_matrix(axes_ * Vector3d(v.x.value, v.y.value, v.z.value));
    return rows;
  }

  Eigen::Matrix3d axes_, by_turn_;
  Vector3d d_, u_, w_a_, w_b_;
  Eigen::Matrix<double, Dual::inputs, 1> numbers_;
};

}  // namespace freeplay::space
