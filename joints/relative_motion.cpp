#include "relative_motion.h"

namespace freeplay::space {

PairInFirstAxes::PairInFirstAxes(const JointInput& in, const Vector3d& r, const Eigen::Matrix3d& by_turn)
    : axes_(rotation(*in.a)),
      by_turn_(by_turn),
      d_(position(*in.b) - position(*in.a)),
      u_(velocity(*in.b) - velocity(*in.a)),
      w_a_(angular_velocity(*in.a)),
      w_b_(angular_velocity(*in.b)) {
  const Eigen::Matrix3d to_a = axes_.transpose();
  numbers_ << to_a * d_, r, to_a * u_, to_a * w_a_, to_a * w_b_;
}

PairInFirstAxes PairInFirstAxes::with_axis(const JointInput& in, int k) {
  const Vector3d world = axis(*in.b, k);
  const Eigen::Matrix3d to_a = rotation(*in.a).transpose();
  return {in, to_a * world, -to_a * cross_matrix(world)};
}

PairInFirstAxes PairInFirstAxes::with_rotation_vector(const JointInput& in) {
  const RotationVector rho(in);
  return {in, rho.value, rho.rate_matrix() * rotation(*in.a).transpose()};
}

RelativeMotion<Dual> PairInFirstAxes::duals() const {
  const auto one = [this](int i) { return Dual(numbers_[i], Dual::Gradient::Unit(i)); };
  const auto at = [&](int i) { return Vec<Dual>{one(i), one(i + 1), one(i + 2)}; };
  return {at(0), at(3), at(6), at(9), at(12)};
}

Dual::Gradient PairInFirstAxes::rates(const MarkerAccelerations& acc) const {
  const Eigen::Matrix3d to_a = axes_.transpose();
  using Input = Eigen::Map<const Vector3d>;
  const Vector3d u_rate = Input(acc.b) - Input(acc.a);
  Dual::Gradient rates;
  rates << to_a * (u_ - w_a_.cross(d_)), by_turn_ * (w_b_ - w_a_), to_a * (u_rate - w_a_.cross(u_)),
      to_a * Input(acc.a + 3), to_a * (Input(acc.b + 3) - w_a_.cross(w_b_));
  return rates;
}

void PairInFirstAxes::write(const RelativeForce<double>& f, JointForces& out) const {
  const auto turned = [this](const Vec<double>& v) { return Vector3d(axes_ * Vector3d(v.x, v.y, v.z)); };
  const Vector3d force = turned(f.force), moment_a = turned(f.moment_a), moment_b = turned(f.moment_b);
  for (int i = 0; i < 3; ++i) {
    out.wrench_a[i] = -force[i];
    out.wrench_b[i] = force[i];
    out.wrench_a[3 + i] = moment_a[i];
    out.wrench_b[3 + i] = moment_b[i];
  }
}

void PairInFirstAxes::write_derivatives(const RelativeForce<Dual>& f, Eigen::Index columns, JointForces& out) const {
  const Inputs inputs = inputs_by_markers();
  const Rows by_force = in_world(f.force, inputs);
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<Table> table(out.derivatives.data, 12, columns);
  table.block<3, 24>(0, 0) = -by_force;
  table.block<3, 24>(3, 0) = in_world(f.moment_a, inputs);
  table.block<3, 24>(6, 0) = by_force;
  table.block<3, 24>(9, 0) = in_world(f.moment_b, inputs);
}

void PairInFirstAxes::write_rate_derivatives(std::size_t index, const Dual& rate, Eigen::Index columns,
                                             JointForces& out) const {
  Eigen::Map<Eigen::Matrix<double, 1, 24>>(out.derivatives.data + (12 + index) * static_cast<std::size_t>(columns)) =
      rate.gradient.transpose() * inputs_by_markers();
}

void PairInFirstAxes::write_internal_column(std::size_t index, const RelativeForce<double>& f, Eigen::Index columns,
                                            JointForces& out) const {
  JointForces part{};
  write(f, part);
  for (std::size_t i = 0; i < 6; ++i) {
    out.derivatives[i * static_cast<std::size_t>(columns) + 24 + index] = part.wrench_a[i];
    out.derivatives[(6 + i) * static_cast<std::size_t>(columns) + 24 + index] = part.wrench_b[i];
  }
}

PairInFirstAxes::Inputs PairInFirstAxes::inputs_by_markers() const {
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

PairInFirstAxes::Rows PairInFirstAxes::in_world(const Vec<Dual>& v, const Inputs& inputs) const {
  Eigen::Matrix<double, 3, Dual::inputs> gradient;
  gradient << v.x.gradient.transpose(), v.y.gradient.transpose(), v.z.gradient.transpose();
  Rows rows = axes_ * (gradient * inputs);
  rows.middleCols<3>(3) -= cross_matrix(axes_ * Vector3d(v.x.value, v.y.value, v.z.value));
  return rows;
}

}  // namespace freeplay::space
