#include "joint_probe.h"

namespace freeplay::test {
namespace {

class PointOnLineTest : public testing::Test {
 protected:
  const Component& row_ = joint_row("point-on-line");
  JointInstance joint_{row_, ParameterStub(row_)};
};

TEST_F(PointOnLineTest, MeasuresAcrossAndAlongTheAxisOfTheFirstFrame) {
  // First frame turned by 90 degrees: its x axis is world y, its normal is -x. The second may turn as it likes.
  const MarkerKinematics a = planar_marker(1.0, 1.0, M_PI / 2), b = planar_marker(1.5, 3.0, -1.1);
  const Rows rows = constraint_rows(joint_, a, b);
  ASSERT_EQ(rows.phi.size(), 1u);
  EXPECT_NEAR(rows.phi[0], -0.5, 1e-15);
  EXPECT_NEAR(coordinate_row(joint_, a, b).value, 2.0, 1e-15);
}

TEST_F(PointOnLineTest, RowsAreDerivativesOffTheConstraintToo) { expect_rows_are_derivatives(joint_); }
TEST_F(PointOnLineTest, CoordinateRowIsDerivative) { expect_coordinate_row_is_derivative(joint_); }

}  // namespace
}  // namespace freeplay::test
