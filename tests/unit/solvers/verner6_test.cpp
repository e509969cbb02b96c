#include <cmath>

#include "oscillator.h"

namespace freeplay::test {
namespace {

OscillatorRun start(double omega, double q0, double v0, double z0 = 0.0, double decay = 0.0) {
  return OscillatorRun("verner6", ParameterStub(component(freeplay_plugin_v1_solvers, "verner6")),
                       {.omega = omega, .decay = decay, .estimates = true}, q0, v0, z0);
}

/// Distance from the exact motion at t = 1.
double error_at_one(int steps) {
  OscillatorRun run = start(2.0, 0.3, -0.7, 1.0, 1.5);
  for (int i = 0; i < steps; ++i) run.step(1.0 / steps);
  const double q = 0.3 * std::cos(2.0) - 0.35 * std::sin(2.0);
  return std::abs(run.q[0] - q) + std::abs(run.z[0] - std::exp(-1.5));
}

TEST(Verner6, HasOrderSix) {
  EXPECT_NEAR(std::log2(error_at_one(8) / error_at_one(16)), 6.0, 0.3);
  EXPECT_NEAR(std::log2(error_at_one(16) / error_at_one(32)), 6.0, 0.2);
}

TEST(Verner6, ErrorFallsWithTheSixthPowerOfTheStep) {
  double errors[3];
  for (int i = 0; i < 3; ++i) errors[i] = start(1.0, 1.0, 0.5).step(0.2 / (1 << i)).error;
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 6.0, 0.3);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 6.0, 0.2);
}

TEST(Verner6, TakesEightEvaluationsAStep) {
  OscillatorRun run = start(1.0, 1.0, 0.0);
  const int before = run.oscillator.accelerations;
  run.step(0.1);
  run.step(0.1);
  EXPECT_EQ(run.oscillator.accelerations - before, 16);
  EXPECT_TRUE(run.oscillator.stages.empty());
}

}  // namespace
}  // namespace freeplay::test
