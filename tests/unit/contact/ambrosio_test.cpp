#include "friction_coefficient_law.h"

namespace freeplay::test {
namespace {

// Closed form with mu = 0.1, v0 = 1e-4, v1 = 1e-3 m/s: mu_eff = mu (|v| - v0)/(v1 - v0) sign(v) on the ramp.
TEST(Ambrosio, CoefficientRisesOnARampAndOpposesSlip) {
  const FrictionUnderTest under_test("ambrosio", {{"mu", 0.1}});
  const struct {
    double slip, coefficient;
  } cases[] = {{0.0, 0.0},   {5e-5, 0.0}, {-5e-4, -0.0444444444444445}, {9e-4, 0.0888888888888889}, {2e-3, 0.1},
               {-0.3, -0.1}, {1e-3, 0.1}};
  for (const auto& c : cases) {
    const FrictionForce f = under_test.law.evaluate({200.0, c.slip, {}}, {});
    EXPECT_NEAR(f.tangential, -200.0 * c.coefficient, 1e-12);
    EXPECT_NEAR(f.d_normal, -c.coefficient, 1e-15);
    EXPECT_LE(f.tangential * c.slip, 0.0);
  }
}

TEST(Ambrosio, SlopeAgreesWithDifferences) {
  const FrictionUnderTest under_test("ambrosio", {{"mu", 0.1}});
  for (const double slip : {5e-5, 5e-4, -5e-4, 0.2}) {
    const double h = 1e-6;
    const double slope = (under_test.law.evaluate({200.0, slip + h, {}}, {}).tangential -
                          under_test.law.evaluate({200.0, slip - h, {}}, {}).tangential) /
                         (2.0 * h);
    EXPECT_NEAR(under_test.law.evaluate({200.0, slip, {}}, {}).d_slip, slope, 1e-6);
  }
}

TEST(Ambrosio, DeclaresItsKinks) { expect_kinks("ambrosio", {{"mu", 0.1}, {"v0", 2e-4}}, {2e-4, 1e-3}); }

TEST(Ambrosio, RefusesARampThatDoesNotRise) {
  const auto make = [](double v0, double v1) {
    return bad_parameter_id([&] { FrictionUnderTest("ambrosio", {{"mu", 0.1}, {"v0", v0}, {"v1", v1}}); });
  };
  EXPECT_EQ(make(1e-3, 1e-3), "out-of-range");
  EXPECT_EQ(make(2e-3, 1e-3), "out-of-range");
  EXPECT_EQ(make(0.0, 1e-3), "");
}

}  // namespace
}  // namespace freeplay::test
