// Optional for authors: Eigen views of the SDK's plain data. No Eigen type crosses the boundary.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "freeplay/joint.h"

namespace freeplay {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

inline Eigen::Map<const Eigen::Vector3d> vector3(const double (&x)[3]) { return Eigen::Map<const Eigen::Vector3d>(x); }
inline Eigen::Map<const RowMajor3> rotation(const MarkerKinematics& m) {
  return Eigen::Map<const RowMajor3>(m.rotation);
}

/// Adds `force` acting on body b at the world point `point`, and its reaction on body a.
inline void add_force(const JointInput& in, JointForces& out, const Eigen::Vector3d& point,
                      const Eigen::Vector3d& force) {
  Eigen::Map<Eigen::Matrix<double, 6, 1>> wa(out.wrench_a), wb(out.wrench_b);
  wa.head<3>() -= force;
  wa.tail<3>() -= (point - vector3(in.a->position)).cross(force);
  wb.head<3>() += force;
  wb.tail<3>() += (point - vector3(in.b->position)).cross(force);
}

/// Adds `torque` acting on body b and its reaction on body a.
inline void add_torque(JointForces& out, const Eigen::Vector3d& torque) {
  Eigen::Map<Eigen::Vector3d>(out.wrench_a + 3) -= torque;
  Eigen::Map<Eigen::Vector3d>(out.wrench_b + 3) += torque;
}

}  // namespace freeplay
