#include "friction_coefficient_law.h"

namespace freeplay::test {
namespace {

TEST(CoulombLinear, CoefficientIsThatOfTheFormula) {
  expect_coefficients("coulomb-linear", {{"mu", 0.1}},
                      {{0.0, 0.0}, {5e-05, 0.005}, {-0.0005, -0.05}, {0.0009, 0.09}, {0.002, 0.1}, {-0.3, -0.1}});
}

TEST(CoulombLinear, SlopeAgreesWithDifferences) {
  expect_slopes("coulomb-linear", {{"mu", 0.1}, {"vs", 0.001}}, {5e-5, 9e-4, 2e-3, 0.3});
}

TEST(CoulombLinear, TableBoundsItsParameters) {
  EXPECT_EQ(parameter_of("coulomb-linear", "mu").minimum, 0.0);
  EXPECT_EQ(parameter_of("coulomb-linear", "vs").default_value, 1e-3);
  EXPECT_EQ(parameter_of("coulomb-linear", "vs").open, Open::minimum);
}

TEST(CoulombLinear, DeclaresItsKink) { expect_kinks("coulomb-linear", {{"mu", 0.1}, {"vs", 2e-3}}, {2e-3}); }

}  // namespace
}  // namespace freeplay::test
