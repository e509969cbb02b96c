#include "friction_coefficient_law.h"

namespace freeplay::test {
namespace {

TEST(CoulombAtan, CoefficientIsThatOfTheFormula) {
  expect_coefficients("coulomb-atan", {{"mu", 0.1}},
                      {{0.0, 0.0},
                       {5e-05, 0.00318045025123528},
                       {-0.0005, -0.0295167235300867},
                       {0.0009, 0.0466524583286852},
                       {0.002, 0.0704832764699133},
                       {-0.3, -0.0997877941951559}});
}

TEST(CoulombAtan, SlopeAgreesWithDifferences) {
  expect_slopes("coulomb-atan", {{"mu", 0.1}, {"vs", 0.001}}, {5e-5, 4e-4, 2e-3});
}

TEST(CoulombAtan, TableBoundsItsParameters) {
  EXPECT_EQ(parameter_of("coulomb-atan", "mu").minimum, 0.0);
  EXPECT_EQ(parameter_of("coulomb-atan", "vs").default_value, 1e-3);
  EXPECT_EQ(parameter_of("coulomb-atan", "vs").open, Open::minimum);
}

}  // namespace
}  // namespace freeplay::test
