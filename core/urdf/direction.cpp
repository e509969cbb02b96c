#include "urdf/direction.h"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace freeplay::urdf {
namespace {

/// Cosine below which the axis of half a turn is any across both directions.
constexpr double opposite = -1.0 + 1e-12;

}  // namespace

double length_of(const Eigen::Vector3d& v) { return v.stableNorm(); }

std::optional<Eigen::Matrix3d> turn_of_quaternion(double w, double x, double y, double z) {
  Eigen::Quaterniond q(w, x, y, z);
  const double length = q.coeffs().stableNorm();
  if (!(length > shortest_direction)) return std::nullopt;
  q.coeffs() /= length;
  return q.toRotationMatrix();
}

Eigen::Isometry3d inverse_pose(const Eigen::Isometry3d& pose) { return pose.inverse(); }

Eigen::Matrix3d least_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond turn;
  if (cosine < opposite) {
    const Eigen::Vector3d beside(-a.z(), 0.0, a.x());
    turn.vec() = beside.norm() > 0.0 ? Eigen::Vector3d(beside.normalized()) : Eigen::Vector3d::UnitZ();
    turn.w() = 0.0;
  } else {
    const double twice = std::sqrt((1.0 + cosine) * 2.0);
    turn.vec() = a.cross(b) * (1.0 / twice);
    turn.w() = twice * 0.5;
  }
  return turn.toRotationMatrix();
}

PrincipalTensor principal(const Eigen::Matrix3d& tensor) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace freeplay::urdf
