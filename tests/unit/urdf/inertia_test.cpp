#include "urdf/inertia.h"

#include <gtest/gtest.h>

namespace freeplay::urdf {
namespace {

Eigen::Matrix3d diagonal(double a, double b, double c) { return Eigen::Vector3d(a, b, c).asDiagonal(); }

TEST(UrdfInertia, JudgesPrincipalValues) {
  EXPECT_EQ(fault_of_inertia(diagonal(1, 1, 1)), "");
  EXPECT_EQ(fault_of_inertia(diagonal(0, 2, 2)), "");
  EXPECT_EQ(fault_of_inertia(diagonal(0, 0, 0)), "");
  EXPECT_EQ(fault_of_inertia(diagonal(1, 1, 2)), "");
  EXPECT_EQ(fault_of_inertia(diagonal(1, 1, 2.000001)), "");  // 1e-6 of the largest is rounding of the file
  EXPECT_NE(fault_of_inertia(diagonal(1, 1, 2.00001)), "");
  EXPECT_NE(fault_of_inertia(diagonal(-1e-9, 1, 1)), "");
  // Off the diagonal: principal values of [[1, 2], [2, 1]] are 3 and -1.
  Eigen::Matrix3d coupled = diagonal(1, 1, 3);
  coupled(0, 1) = coupled(1, 0) = 2;
  EXPECT_EQ(fault_of_inertia(coupled), "a principal value is negative");
}

TEST(UrdfInertia, MendsByRaisingThePrincipalValues) {
  EXPECT_TRUE(repaired(diagonal(1, 2, 2.5)).isApprox(diagonal(1, 2, 2.5)));
  EXPECT_TRUE(repaired(diagonal(-1, 2, 2)).isApprox(diagonal(0, 2, 2)));
  EXPECT_TRUE(repaired(diagonal(1, 2, 5)).isApprox(diagonal(2, 3, 5)));
  EXPECT_TRUE(repaired(diagonal(5, 1, 2)).isApprox(diagonal(5, 2, 3)));
  const Eigen::Matrix3d turn = rotation({0.3, -0.7, 1.1});
  EXPECT_TRUE(
      repaired(turn * diagonal(1, 2, 5) * turn.transpose()).isApprox(turn * diagonal(2, 3, 5) * turn.transpose()));
}

}  // namespace
}  // namespace freeplay::urdf
