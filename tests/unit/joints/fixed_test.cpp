#include "joint_probe.h"

namespace freeplay::test {
namespace {

class FixedTest : public testing::Test {
 protected:
  const Component& row_ = joint_row("fixed");
  JointInstance joint_{row_, ParameterStub(row_)};
};

TEST_F(FixedTest, ResidualIsDifferenceOfOriginsAndOfAngles) {
  const Rows rows = constraint_rows(joint_, planar_marker(1.0, 2.0, 0.3), planar_marker(1.25, 1.5, 0.4 + 2.0 * M_PI));
  ASSERT_EQ(rows.phi.size(), 3u);
  EXPECT_EQ(rows.phi[0], 0.25);
  EXPECT_EQ(rows.phi[1], -0.5);
  EXPECT_NEAR(rows.phi[2], 0.1, 1e-14);
}

TEST_F(FixedTest, RowsAreDerivativesOffTheConstraintToo) { expect_rows_are_derivatives(joint_); }
TEST_F(FixedTest, PlacesABody) { expect_place_agrees_with_rows(joint_, 0.0, false); }

}  // namespace
}  // namespace freeplay::test
