// A joint between two markers that move along given paths, and what every joint's rows must satisfy on them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../parameter_stub.h"

extern "C" freeplay::Status freeplay_plugin_v1_joints(const freeplay::Host*, freeplay::Manifest*) noexcept;

namespace freeplay::test {

inline const Component& joint_row(const std::string& name) { return component(freeplay_plugin_v1_joints, name); }

inline MarkerKinematics planar_marker(double x, double y, double angle, double vx = 0.0, double vy = 0.0,
                                      double w = 0.0) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{x, y, 0.0}, {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0}, {vx, vy, 0.0}, {0.0, 0.0, w}};
}

/// x(t) = x0 + v t + a t^2/2 for (x, y, angle): a marker's motion with constant acceleration.
struct Motion {
  double x[3], v[3], a[3];
  MarkerKinematics at(double t) const {
    double p[3], r[3];
    for (int i = 0; i < 3; ++i) {
      p[i] = x[i] + t * (v[i] + 0.5 * t * a[i]);
      r[i] = v[i] + t * a[i];
    }
    return planar_marker(p[0], p[1], p[2], r[0], r[1], r[2]);
  }
};

// Far from any joint's constraint, so that terms with phi count.
inline constexpr Motion motion_a{{0.3, -0.2, 0.7}, {0.5, 1.1, 2.3}, {-0.7, 0.4, 1.9}};
inline constexpr Motion motion_b{{0.9, 0.4, 1.6}, {-0.8, 0.3, -1.7}, {0.6, -1.2, 0.8}};

struct Rows {
  std::vector<double> phi, jacobian, nu, gamma;
  double rate(std::size_t row, const MarkerKinematics& a, const MarkerKinematics& b) const {
    return dot(row, a.velocity, a.angular_velocity, b.velocity, b.angular_velocity) - nu[row];
  }
  double dot(std::size_t row, const double* va, const double* wa, const double* vb, const double* wb) const {
    double sum = 0.0;
    const double* parts[] = {va, wa, vb, wb};
    for (std::size_t k = 0; k < 12; ++k) sum += jacobian[12 * row + k] * parts[k / 3][k % 3];
    return sum;
  }
};

inline JointInput input(double t, const MarkerKinematics& a, const MarkerKinematics& b, Span<const double> z = {},
                        Span<const double> h = {}) {
  return {t, &a, &b, 0.0, 0.0, z, h};
}

inline Rows constraint_rows(const JointInstance& joint, const MarkerKinematics& a, const MarkerKinematics& b) {
  JointLayout layout;
  joint.call(&abi::JointTable::declare, &layout);
  const std::size_t n = static_cast<std::size_t>(layout.constraint_rows);
  Rows r{std::vector<double>(n), std::vector<double>(12 * n), std::vector<double>(n), std::vector<double>(n)};
  const JointInput in = input(0.0, a, b);
  ConstraintRows rows{{r.phi.data(), n}, {r.jacobian.data(), 12 * n}, {r.nu.data(), n}, {r.gamma.data(), n}};
  joint.call(&abi::JointTable::constrain, &in, &rows);
  return r;
}

inline CoordinateRow coordinate_row(const JointInstance& joint, const MarkerKinematics& a, const MarkerKinematics& b) {
  CoordinateRow row{};
  const JointInput in = input(0.0, a, b);
  joint.call(&abi::JointTable::coordinate, &in, &row);
  return row;
}

/// d(phi)/dt = G V - nu and d(G V - nu)/dt = G dV/dt - gamma along the two motions, by central differences.
inline void expect_rows_are_derivatives(const JointInstance& joint) {
  const double h = 1e-5;  // error of the differences 1e-10
  const auto rows_at = [&](double t) { return constraint_rows(joint, motion_a.at(t), motion_b.at(t)); };
  const Rows now = rows_at(0.0), before = rows_at(-h), after = rows_at(h);
  const double va[3] = {motion_a.a[0], motion_a.a[1], 0.0}, wa[3] = {0.0, 0.0, motion_a.a[2]};
  const double vb[3] = {motion_b.a[0], motion_b.a[1], 0.0}, wb[3] = {0.0, 0.0, motion_b.a[2]};
  for (std::size_t i = 0; i < now.phi.size(); ++i) {
    EXPECT_NEAR(now.rate(i, motion_a.at(0.0), motion_b.at(0.0)), (after.phi[i] - before.phi[i]) / (2.0 * h), 1e-8);
    const double second =
        (after.rate(i, motion_a.at(h), motion_b.at(h)) - before.rate(i, motion_a.at(-h), motion_b.at(-h))) / (2.0 * h);
    EXPECT_NEAR(now.dot(i, va, wa, vb, wb) - now.gamma[i], second, 1e-7);
  }
}

/// The same for the coordinate: s' = G V, s'' = G dV/dt + bias.
inline void expect_coordinate_row_is_derivative(const JointInstance& joint) {
  const double h = 1e-5;
  const auto rate_at = [&](double t) {
    const MarkerKinematics a = motion_a.at(t), b = motion_b.at(t);
    const CoordinateRow row = coordinate_row(joint, a, b);
    const double* parts[] = {a.velocity, a.angular_velocity, b.velocity, b.angular_velocity};
    double sum = 0.0;
    for (int k = 0; k < 12; ++k) sum += row.jacobian[k] * parts[k / 3][k % 3];
    return sum;
  };
  const auto value_at = [&](double t) { return coordinate_row(joint, motion_a.at(t), motion_b.at(t)).value; };
  EXPECT_NEAR(rate_at(0.0), (value_at(h) - value_at(-h)) / (2.0 * h), 1e-8);
  const CoordinateRow now = coordinate_row(joint, motion_a.at(0.0), motion_b.at(0.0));
  double second = now.bias;
  for (int k = 0; k < 2; ++k) second += now.jacobian[k] * motion_a.a[k] + now.jacobian[6 + k] * motion_b.a[k];
  second += now.jacobian[5] * motion_a.a[2] + now.jacobian[11] * motion_b.a[2];
  EXPECT_NEAR(second, (rate_at(h) - rate_at(-h)) / (2.0 * h), 1e-7);
}

/// A body placed by place(s) stands on the constraint and its coordinate is s.
inline void expect_place_agrees_with_rows(const JointInstance& joint, double s, bool has_coordinate) {
  Pose pose{};
  std::int32_t can = 0;
  joint.call(&abi::JointTable::place, s, &pose, &can);
  ASSERT_EQ(can, 1);
  const double angle = 0.7, c = std::cos(angle), n = std::sin(angle);
  const MarkerKinematics a = planar_marker(0.3, -0.2, angle);
  const MarkerKinematics b = planar_marker(0.3 + c * pose.position[0] - n * pose.position[1],
                                           -0.2 + n * pose.position[0] + c * pose.position[1],
                                           angle + std::atan2(pose.rotation[3], pose.rotation[0]));
  for (const double phi : constraint_rows(joint, a, b).phi) EXPECT_NEAR(phi, 0.0, 1e-15);
  if (!has_coordinate) return;
  EXPECT_NEAR(coordinate_row(joint, a, b).value, s, 1e-15);
}

}  // namespace freeplay::test
