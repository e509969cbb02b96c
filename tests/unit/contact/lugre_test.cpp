#include <algorithm>
#include <cmath>

#include "law_probe.h"

namespace freeplay::test {
namespace {

const Numbers lugre_numbers = {{"mu_s", 0.15},  {"mu_k", 0.1},    {"v_stribeck", 0.01},
                               {"sigma0", 1e5}, {"sigma1", 10.0}, {"sigma2", 0.02}};

struct LugreSample {
  FrictionForce force;
  double rate;
};
LugreSample evaluate(const FrictionUnderTest& friction, double normal, double slip, double z) {
  double rate = 0.0;
  const FrictionForce f = friction.law.evaluate({normal, slip, {&z, 1}}, {&rate, 1});
  return {f, rate};
}

// z and z' of the exact solution at constant slip; 13 digits of z leave 1e-13 of sigma0 |v|/g z in z'.
TEST(Lugre, CoefficientAndRateAreThoseOfTheFormula) {
  const FrictionUnderTest friction("lugre", lugre_numbers);
  EXPECT_EQ(friction.law.internal_variables(), 1);
  const struct {
    double slip, z, rate, coefficient;
  } cases[] = {{0.001, 9.6728911594214e-08, 0.000935299465245, 0.01904588581187},
               {0.001, 1.4931640425885e-06, 1.24471121859e-06, 0.149348851371},
               {-0.05, 2.1306131942675e-07, -0.0606530659713, -0.58622452777},
               {0.3, 1e-06, 2.47333620598e-18, 0.106}};
  for (const auto& c : cases) {
    const LugreSample s = evaluate(friction, 200.0, c.slip, c.z);
    EXPECT_NEAR(s.rate, c.rate, 2e-13);
    EXPECT_NEAR(s.force.tangential, -200.0 * c.coefficient, 1e-9);
    EXPECT_NEAR(s.force.d_normal, -c.coefficient, 5e-12);
  }
}

// The bristle follows z_s + (z_0 - z_s) exp(-sigma0 |v| t/g) from z_0 over the time t.
TEST(Lugre, BristleRelaxesAsTheExactSolution) {
  const FrictionUnderTest friction("lugre", lugre_numbers);
  const struct {
    double slip, start, time, end;
  } cases[] = {{0.001, 0.0, 0.0001, 9.6728911594214e-08},
               {0.001, 0.0, 0.01, 1.4931640425885e-06},
               {-0.05, 1e-06, 1e-05, 2.1306131942675e-07}};
  for (const auto& c : cases) {
    double z = c.start;
    const int steps = 2000;
    const double h = c.time / steps;
    const auto rate = [&](double at) { return evaluate(friction, 1.0, c.slip, at).rate; };
    for (int i = 0; i < steps; ++i) {
      const double k1 = rate(z), k2 = rate(z + 0.5 * h * k1), k3 = rate(z + 0.5 * h * k2), k4 = rate(z + h * k3);
      z += h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
      EXPECT_LE(std::abs(z), 0.15 / 1e5);  // mu_s/sigma0
    }
    EXPECT_NEAR(z / c.end, 1.0, 1e-9);
  }
}

TEST(Lugre, SteadySlipIsDissipative) {
  const FrictionUnderTest friction("lugre", lugre_numbers);
  for (const double slip : {-0.3, -0.01, -1e-5, 1e-5, 0.01, 0.3}) {
    const double g = 0.1 + 0.05 * std::exp(-slip * slip / 1e-4);
    const LugreSample s = evaluate(friction, 1.0, slip, std::copysign(g / 1e5, slip));
    EXPECT_NEAR(s.rate, 0.0, 1e-15);
    EXPECT_NEAR(s.force.tangential, -std::copysign(g, slip) - 0.02 * slip, 1e-13);
    EXPECT_LT(s.force.tangential * slip, 0.0);
  }
}

TEST(Lugre, SlopeAgreesWithDifferences) {
  const FrictionUnderTest friction("lugre", lugre_numbers);
  for (const double z : {-1e-6, 0.0, 4e-7})
    for (const double slip : {-0.2, -0.01, 1e-4, 0.003, 0.3}) {
      const double h = 1e-4 * std::abs(slip);
      const double slope = (evaluate(friction, 200.0, slip + h, z).force.tangential -
                            evaluate(friction, 200.0, slip - h, z).force.tangential) /
                           (2.0 * h);
      EXPECT_NEAR(evaluate(friction, 200.0, slip, z).force.d_slip, slope, 1e-6 * std::abs(slope) + 1e-13 / h);
    }
  EXPECT_NEAR(evaluate(friction, 200.0, 0.0, 0.0).force.d_slip, -200.0 * 10.02, 1e-10);  // sigma1 + sigma2
}

TEST(Lugre, RefusesStaticBelowKineticFriction) {
  const auto id = [](double mu_s, double mu_k) {
    return bad_parameter_id([&] {
      FrictionUnderTest("lugre", {{"mu_s", mu_s}, {"mu_k", mu_k}, {"v_stribeck", 0.01}, {"sigma0", 1e5}});
    });
  };
  EXPECT_EQ(id(0.1, 0.15), "out-of-range");
  EXPECT_EQ(id(0.1, 0.1), "");
}

TEST(Lugre, TableBoundsItsParameters) {
  EXPECT_EQ(parameter_of("lugre", "mu_k").open, Open::minimum);  // g must not vanish
  EXPECT_EQ(parameter_of("lugre", "sigma0").open, Open::minimum);
  EXPECT_EQ(parameter_of("lugre", "sigma1").default_value, 0.0);
  EXPECT_EQ(parameter_of("lugre", "sigma2").default_value, 0.0);
}

TEST(Lugre, DeclaresTheKinkOfItsRateAtRest) {
  const FrictionUnderTest friction("lugre", lugre_numbers);
  EXPECT_TRUE(std::ranges::equal(friction.law.kinks(), std::initializer_list<double>{0.0}));
  const auto slope = [&](double slip) {
    const double h = 0.1 * slip;
    return (evaluate(friction, 1.0, slip + h, 1e-6).rate - evaluate(friction, 1.0, slip - h, 1e-6).rate) / (2.0 * h);
  };
  EXPECT_GT(std::abs(slope(1e-9) - slope(-1e-9)), 0.1 * std::abs(slope(1e-9)));
}

}  // namespace
}  // namespace freeplay::test
