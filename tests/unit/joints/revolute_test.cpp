#include "joint_probe.h"

namespace freeplay::test {
namespace {

class RevoluteTest : public testing::Test {
 protected:
  const Component& row_ = joint_row("revolute");
  JointInstance joint_{row_, ParameterStub(row_)};
};

TEST_F(RevoluteTest, NamesItsEnds) {
  EXPECT_STREQ(row_.description.first_end, "bearing");
  EXPECT_STREQ(row_.description.second_end, "journal");
}

TEST_F(RevoluteTest, IsAPinWithTwoRowsAndAnAngle) {
  JointLayout layout;
  joint_.call(&abi::JointTable::declare, &layout);
  EXPECT_EQ(layout.constraint_rows, 2);
  EXPECT_EQ(layout.coordinate, Coordinate::angle);
  EXPECT_EQ(layout.pin, 1u);
  EXPECT_EQ(layout.forces, 0u);
}

TEST_F(RevoluteTest, ResidualIsSecondOriginMinusFirst) {
  const Rows rows = constraint_rows(joint_, planar_marker(1.0, 2.0, 0.3), planar_marker(1.25, 1.5, 0.4));
  EXPECT_EQ(rows.phi[0], 0.25);
  EXPECT_EQ(rows.phi[1], -0.5);
}

TEST_F(RevoluteTest, RowsAreDerivativesOffTheConstraintToo) { expect_rows_are_derivatives(joint_); }
TEST_F(RevoluteTest, CoordinateRowIsDerivative) { expect_coordinate_row_is_derivative(joint_); }
TEST_F(RevoluteTest, PlacesABodyAtAnAngle) { expect_place_agrees_with_rows(joint_, -1.2, true); }

TEST_F(RevoluteTest, AngleIsThatOfTheSecondRelativeToTheFirst) {
  EXPECT_NEAR(coordinate_row(joint_, planar_marker(0, 0, 0.3), planar_marker(0, 0, 1.0)).value, 0.7, 1e-15);
  // 3.0 - (-3.0) = 6.0 = -0.283... after one turn
  EXPECT_NEAR(coordinate_row(joint_, planar_marker(0, 0, -3.0), planar_marker(0, 0, 3.0)).value, 6.0 - 2.0 * M_PI,
              1e-15);
}

}  // namespace
}  // namespace freeplay::test
