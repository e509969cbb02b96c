#include "law_probe.h"

namespace freeplay::test {
namespace {

TEST(NoFriction, HasNoForceAndIsTheDefault) {
  const FrictionUnderTest under_test("none", {});
  const FrictionForce f = under_test.law.evaluate({1e3, 0.5, {}}, {});
  EXPECT_EQ(f.tangential, 0.0);
  EXPECT_EQ(f.d_normal, 0.0);
  EXPECT_EQ(f.d_slip, 0.0);
  EXPECT_EQ(under_test.law.internal_variables(), 0);
  EXPECT_NE(ContactUnderTest::row("none").description.preferred, 0u);
}

}  // namespace
}  // namespace freeplay::test
