#include "friction_coefficient_law.h"

namespace freeplay::test {
namespace {

TEST(BengisuAkay, CoefficientIsThatOfTheFormula) {
  expect_coefficients("bengisu-akay", {{"mu_s", 0.15}, {"mu_k", 0.1}, {"xi", 100.0}},
                      {{0.0, 0.0},
                       {5e-05, 0.014625},
                       {-0.0005, -0.1125},
                       {0.0009, 0.1485},
                       {0.002, 0.145241870901798},
                       {-0.3, -0.100000000000005}});
}

TEST(BengisuAkay, SlopeAgreesWithDifferences) {
  expect_slopes("bengisu-akay", {{"mu_s", 0.15}, {"mu_k", 0.1}, {"v0", 0.001}, {"xi", 100.0}},
                {5e-5, 5e-4, 2e-3, 0.02});
}

TEST(BengisuAkay, ReachesTheStaticCoefficientAtItsPeak) {
  const FrictionUnderTest friction("bengisu-akay", {{"mu_s", 0.15}, {"mu_k", 0.1}, {"xi", 100.0}});
  EXPECT_NEAR(friction.law.evaluate({1.0, 1e-3, {}}, {}).tangential, -0.15, 1e-15);
  EXPECT_NEAR(friction.law.evaluate({1.0, 1e-3 * (1.0 - 1e-9), {}}, {}).tangential, -0.15, 1e-15);
}

TEST(BengisuAkay, RefusesStaticBelowKineticFriction) {
  const auto id = [](double mu_s, double mu_k) {
    return bad_parameter_id([&] {
      FrictionUnderTest("bengisu-akay", {{"mu_s", mu_s}, {"mu_k", mu_k}, {"xi", 100.0}});
    });
  };
  EXPECT_EQ(id(0.1, 0.15), "out-of-range");
  EXPECT_EQ(id(0.1, 0.1), "");
}

TEST(BengisuAkay, DeclaresItsKink) {
  expect_kinks("bengisu-akay", {{"mu_s", 0.15}, {"mu_k", 0.1}, {"v0", 2e-3}, {"xi", 100.0}}, {2e-3});
}

}  // namespace
}  // namespace freeplay::test
