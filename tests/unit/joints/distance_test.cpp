#include "joint_probe.h"

namespace freeplay::test {
namespace {

class DistanceTest : public testing::Test {
 protected:
  static ParameterStub rod(const Component& row) {
    ParameterStub stub(row);
    stub.numbers["length"] = 0.5;
    return stub;
  }
  const Component& row_ = joint_row("distance");
  JointInstance joint_{row_, rod(row_)};
};

TEST_F(DistanceTest, ResidualIsDistanceLessLength) {
  const Rows rows = constraint_rows(joint_, planar_marker(1.0, 2.0, 0.3), planar_marker(1.6, 2.8, 0.4));
  ASSERT_EQ(rows.phi.size(), 1u);
  EXPECT_NEAR(rows.phi[0], 0.5, 1e-15);  // 3-4-5 triangle: 1 m less 0.5 m
}

TEST_F(DistanceTest, RowsAreDerivativesOffTheConstraintToo) { expect_rows_are_derivatives(joint_); }

TEST_F(DistanceTest, HasADirectionWhereTheOriginsCoincide) {
  const MarkerKinematics a = planar_marker(1.0, 2.0, M_PI / 2);
  const Rows rows = constraint_rows(joint_, a, a);
  EXPECT_EQ(rows.phi[0], -0.5);
  EXPECT_NEAR(rows.jacobian[7], 1.0, 1e-15);
  EXPECT_EQ(rows.gamma[0], 0.0);
}

TEST_F(DistanceTest, HasNeitherCoordinateNorPlace) {
  JointLayout layout;
  joint_.call(&abi::JointTable::declare, &layout);
  EXPECT_EQ(layout.constraint_rows, 1);
  EXPECT_EQ(layout.coordinate, Coordinate::none);
  Pose pose{};
  std::int32_t can = 1;
  joint_.call(&abi::JointTable::place, 0.0, &pose, &can);
  EXPECT_EQ(can, 0);
}

}  // namespace
}  // namespace freeplay::test
