#include "friction_coefficient_law.h"

namespace freeplay::test {
namespace {

TEST(CoulombTanh, CoefficientIsThatOfTheFormula) {
  expect_coefficients("coulomb-tanh", {{"mu", 0.1}},
                      {{0.0, 0.0},
                       {5e-05, 0.004995837495788},
                       {-0.0005, -0.046211715726001},
                       {0.0009, 0.0716297870199025},
                       {0.002, 0.0964027580075817},
                       {-0.3, -0.1}});
}

TEST(CoulombTanh, SlopeAgreesWithDifferences) {
  expect_slopes("coulomb-tanh", {{"mu", 0.1}, {"vs", 0.001}}, {5e-5, 4e-4, 2e-3});
}

TEST(CoulombTanh, TableBoundsItsParameters) {
  EXPECT_EQ(parameter_of("coulomb-tanh", "mu").minimum, 0.0);
  EXPECT_EQ(parameter_of("coulomb-tanh", "vs").default_value, 1e-3);
  EXPECT_EQ(parameter_of("coulomb-tanh", "vs").open, Open::minimum);
}

}  // namespace
}  // namespace freeplay::test
