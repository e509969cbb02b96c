#include "friction_coefficient_law.h"

namespace freeplay::test {
namespace {

TEST(Stribeck, CoefficientIsThatOfTheFormula) {
  expect_coefficients(
      "stribeck",
      {{"mu_s", 0.15}, {"mu_k", 0.1}, {"v_stribeck", 0.01}, {"exponent", 2.0}, {"vs", 0.0001}, {"viscous", 0.02}},
      {{0.0, 0.0},
       {5e-05, 0.0693179959497754},
       {-0.0005, -0.149871548094554},
       {0.0009, 0.149614631273571},
       {0.002, 0.148079471957616},
       {-0.3, -0.106}});
}

TEST(Stribeck, SlopeAgreesWithDifferences) {
  expect_slopes(
      "stribeck",
      {{"mu_s", 0.15}, {"mu_k", 0.1}, {"v_stribeck", 0.01}, {"exponent", 2.0}, {"vs", 0.0001}, {"viscous", 0.02}},
      {5e-5, 5e-4, 0.01, 0.3});
}

TEST(Stribeck, SlopeIsBoundedAtRestForEveryExponent) {
  for (const double exponent : {0.5, 1.0, 3.0}) {
    const Numbers numbers = {{"mu_s", 0.15}, {"mu_k", 0.1}, {"v_stribeck", 0.01}, {"exponent", exponent}, {"vs", 1e-4}};
    expect_slopes("stribeck", numbers, {5e-5, 0.004});
    const FrictionUnderTest friction("stribeck", numbers);
    EXPECT_NEAR(friction.law.evaluate({1.0, 0.0, {}}, {}).d_slip, -1500.0, 1e-9);  // mu_s/vs
  }
}

TEST(Stribeck, RefusesStaticBelowKineticFriction) {
  const auto id = [](double mu_s, double mu_k) {
    return bad_parameter_id([&] {
      FrictionUnderTest("stribeck", {{"mu_s", mu_s}, {"mu_k", mu_k}, {"v_stribeck", 0.01}});
    });
  };
  EXPECT_EQ(id(0.1, 0.15), "out-of-range");
  EXPECT_EQ(id(0.1, 0.1), "");
}

TEST(Stribeck, TableHoldsTheDefaults) {
  EXPECT_EQ(parameter_of("stribeck", "vs").default_value, 1e-3);
  EXPECT_EQ(parameter_of("stribeck", "exponent").default_value, 2.0);
  EXPECT_EQ(parameter_of("stribeck", "viscous").default_value, 0.0);
}

}  // namespace
}  // namespace freeplay::test
