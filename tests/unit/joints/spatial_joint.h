// A joint in space between two markers that move along given paths, and what holds for every such joint.
#pragma once

#include <functional>
#include <random>

#include "freeplay/eigen.h"
#include "joint_probe.h"

namespace freeplay::test {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Wrenches = Eigen::Matrix<double, 12, 1>;

/// The component as spatial models see it: its class for space stands where that of the plane stood.
inline Component in_space(const Component& row) {
  Component spatial = row;
  if (row.description.in_space.table == nullptr) return spatial;
  spatial.table = row.description.in_space.table;
  spatial.create = row.description.in_space.create;
  return spatial;
}

inline Matrix3d turn(const Vector3d& vector) {
  const double angle = vector.norm();
  if (angle == 0.0) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

inline MarkerKinematics marker(const Vector3d& position, const Matrix3d& rotation, const Vector3d& velocity = {0, 0, 0},
                               const Vector3d& angular_velocity = {0, 0, 0}) {
  MarkerKinematics m{};
  Eigen::Map<Vector3d>(m.position) = position;
  Eigen::Map<RowMajor3>(m.rotation) = rotation;
  Eigen::Map<Vector3d>(m.velocity) = velocity;
  Eigen::Map<Vector3d>(m.angular_velocity) = angular_velocity;
  return m;
}

/// A motion about the world's axes whose rotation is exact: R(t) = exp(t w1) exp(t w2) R0, x(t) of second order. Its
/// angular acceleration at 0 is w1 x w2.
struct SpatialMotion {
  Vector3d x, v, a, w1, w2;
  Matrix3d r0;
  MarkerKinematics at(double t) const {
    return marker(x + t * v + 0.5 * t * t * a, turn(t * w1) * turn(t * w2) * r0, v + t * a, w1 + turn(t * w1) * w2);
  }
  Vector3d angular_acceleration() const { return w1.cross(w2); }
};

// Far from any joint's constraint, so that terms with phi count.
inline const SpatialMotion spatial_a{{0.3, -0.2, 0.5}, {0.5, 1.1, -0.4}, {-0.7, 0.4, 0.9},
                                     {0.6, -1.1, 0.8}, {1.3, 0.4, -0.7}, turn({0.4, -0.7, 0.9})};
inline const SpatialMotion spatial_b{{0.9, 0.4, -0.1}, {-0.8, 0.3, 0.7}, {0.6, -1.2, 0.2},
                                     {-0.9, 0.5, 0.3}, {0.2, 1.4, 0.6},  turn({-0.3, 0.5, 1.3})};

inline Eigen::Matrix<double, 12, 1> twists(const MarkerKinematics& a, const MarkerKinematics& b) {
  Eigen::Matrix<double, 12, 1> v;
  v << vector3(a.velocity), vector3(a.angular_velocity), vector3(b.velocity), vector3(b.angular_velocity);
  return v;
}

inline Rows spatial_rows(const JointInstance& joint, const MarkerKinematics& a, const MarkerKinematics& b) {
  JointLayout layout;
  layout.space = Space::spatial;
  joint.call(&abi::JointTable::declare, &layout);
  const auto n = static_cast<std::size_t>(layout.constraint_rows);
  Rows r{std::vector<double>(n), std::vector<double>(12 * n), std::vector<double>(n), std::vector<double>(n)};
  const JointInput in = input(0.0, a, b);
  ConstraintRows rows{{r.phi.data(), n}, {r.jacobian.data(), 12 * n}, {r.nu.data(), n}, {r.gamma.data(), n}};
  joint.call(&abi::JointTable::constrain, &in, &rows);
  return r;
}
/// A row of the coordinate in the same form: gamma = -bias.
inline Rows spatial_coordinate(const JointInstance& joint, const MarkerKinematics& a, const MarkerKinematics& b) {
  const CoordinateRow row = coordinate_row(joint, a, b);
  return {{row.value}, {row.jacobian, row.jacobian + 12}, {0.0}, {-row.bias}};
}

using RowsOf = Rows (*)(const JointInstance&, const MarkerKinematics&, const MarkerKinematics&);

/// phi' = G V and d(G V)/dt = G V' - gamma along the two motions, by differences of fourth order.
inline void expect_spatial_derivatives(const JointInstance& joint, RowsOf rows_of = spatial_rows) {
  const double h = 1e-4;  // rates of 10 1/s: error of the differences 1e-10
  const auto at = [&](double t) { return rows_of(joint, spatial_a.at(t), spatial_b.at(t)); };
  const auto rate = [&](const Rows& r, std::size_t i, double t) {
    const auto v = twists(spatial_a.at(t), spatial_b.at(t));
    double sum = 0.0;
    for (int k = 0; k < 12; ++k) sum += r.jacobian[12 * i + static_cast<std::size_t>(k)] * v[k];
    return sum;
  };
  Eigen::Matrix<double, 12, 1> acceleration;
  acceleration << spatial_a.a, spatial_a.angular_acceleration(), spatial_b.a, spatial_b.angular_acceleration();
  const Rows now = at(0.0), before = at(-h), after = at(h), long_before = at(-2.0 * h), long_after = at(2.0 * h);
  const auto slope = [h](double b2, double b1, double a1, double a2) {
    return (8.0 * (a1 - b1) - (a2 - b2)) / (12.0 * h);
  };
  for (std::size_t i = 0; i < now.phi.size(); ++i) {
    EXPECT_NEAR(rate(now, i, 0.0), slope(long_before.phi[i], before.phi[i], after.phi[i], long_after.phi[i]), 1e-9)
        << "row " << i;
    double second = -now.gamma[i];
    for (int k = 0; k < 12; ++k) second += now.jacobian[12 * i + static_cast<std::size_t>(k)] * acceleration[k];
    EXPECT_NEAR(
        second,
        slope(rate(long_before, i, -2.0 * h), rate(before, i, -h), rate(after, i, h), rate(long_after, i, 2.0 * h)),
        1e-8)
        << "row " << i;
  }
}

/// Everything turned and shifted: how a joint looks to another observer.
struct Observer {
  Matrix3d turned = turn({0.7, -1.1, 0.4});
  Vector3d shifted{0.3, 0.8, -0.6};
  MarkerKinematics sees(const MarkerKinematics& m) const {
    return marker(turned * vector3(m.position) + shifted, turned * rotation(m), turned * vector3(m.velocity),
                  turned * vector3(m.angular_velocity));
  }
};

}  // namespace freeplay::test
