#include "friction_coefficient_law.h"

namespace freeplay::test {
namespace {

TEST(Threlfall, CoefficientIsThatOfTheFormula) {
  expect_coefficients("threlfall", {{"mu", 0.1}},
                      {{0.0, 0.0},
                       {5e-05, 0.0146590326165828},
                       {-0.0005, -0.0817574476193644},
                       {0.0009, 0.0981668904103455},
                       {0.002, 0.1},
                       {-0.3, -0.1}});
}

TEST(Threlfall, SlopeAgreesWithDifferences) {
  expect_slopes("threlfall", {{"mu", 0.1}, {"v_r", 0.001}}, {5e-5, 5e-4, 9e-4, 2e-3});
}

TEST(Threlfall, IsContinuousAtItsLimit) {
  const FrictionUnderTest friction("threlfall", {{"mu", 0.1}});
  EXPECT_NEAR(friction.law.evaluate({1.0, 1e-3, {}}, {}).tangential, -0.1, 1e-15);
  EXPECT_NEAR(friction.law.evaluate({1.0, 1.0000001e-3, {}}, {}).tangential, -0.1, 1e-15);
}

TEST(Threlfall, DeclaresItsKink) { expect_kinks("threlfall", {{"mu", 0.1}, {"v_r", 2e-3}}, {2e-3}); }

}  // namespace
}  // namespace freeplay::test
