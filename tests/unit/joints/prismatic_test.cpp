#include "joint_probe.h"

namespace freeplay::test {
namespace {

class PrismaticTest : public testing::Test {
 protected:
  const Component& row_ = joint_row("prismatic");
  JointInstance joint_{row_, ParameterStub(row_)};
};

TEST_F(PrismaticTest, MeasuresAcrossAndAlongTheAxisOfTheFirstFrame) {
  // First frame turned by 90 degrees: its x axis is world y, its normal is -x.
  const MarkerKinematics a = planar_marker(1.0, 1.0, M_PI / 2), b = planar_marker(1.5, 3.0, M_PI / 2 + 0.1);
  const Rows rows = constraint_rows(joint_, a, b);
  EXPECT_NEAR(rows.phi[0], -0.5, 1e-15);
  EXPECT_NEAR(rows.phi[1], 0.1, 1e-15);
  EXPECT_NEAR(coordinate_row(joint_, a, b).value, 2.0, 1e-15);
}

TEST_F(PrismaticTest, AnglesCountUpToWholeTurns) {
  const Rows rows = constraint_rows(joint_, planar_marker(0, 0, 0.2), planar_marker(0, 0, 0.25 - 4.0 * M_PI));
  EXPECT_NEAR(rows.phi[1], 0.05, 1e-14);
}

TEST_F(PrismaticTest, RowsAreDerivativesOffTheConstraintToo) { expect_rows_are_derivatives(joint_); }
TEST_F(PrismaticTest, CoordinateRowIsDerivative) { expect_coordinate_row_is_derivative(joint_); }
TEST_F(PrismaticTest, PlacesABodyAtAPosition) { expect_place_agrees_with_rows(joint_, 0.35, true); }

}  // namespace
}  // namespace freeplay::test
