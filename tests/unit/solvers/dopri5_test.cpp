#include <complex>

#include "oscillator.h"

namespace freeplay::test {
namespace {

OscillatorRun start(double omega, double q0, double v0, double z0 = 0.0, double decay = 0.0) {
  return OscillatorRun("dopri5", ParameterStub(component(freeplay_plugin_v1_solvers, "dopri5")),
                       {.omega = omega, .decay = decay, .estimates = true}, q0, v0, z0);
}

// R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24 + z^5/120 + z^6/600 (Hairer and Wanner, Solving ODEs II, IV.2); with
// w = q + i v/omega the oscillator is w' = -i omega w.
TEST(Dopri5, OneStepIsItsStabilityFunction) {
  for (const double h : {0.1, 0.4, 1.0}) {
    constexpr double omega = 1.5, q0 = 0.3, v0 = -0.7;
    OscillatorRun run = start(omega, q0, v0);
    run.step(h);
    const std::complex<double> z(0.0, -omega * h), w(q0, v0 / omega);
    const std::complex<double> r =
        1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 5.0)))));
    EXPECT_NEAR(run.q[0], (r * w).real(), 2e-15) << h;
    EXPECT_NEAR(run.v[0], omega * (r * w).imag(), 4e-15) << h;
    EXPECT_NEAR(run.a[0], -omega * omega * run.q[0], 1e-14) << h;
    EXPECT_EQ(run.t, h);
  }
}

TEST(Dopri5, InternalVariablesFollowTheSameRule) {
  OscillatorRun run = start(1.0, 0.0, 0.0, 2.0, 3.0);
  run.step(0.2);
  const double z = -0.6;
  const double r = 1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 5.0)))));
  EXPECT_NEAR(run.z[0], 2.0 * r, 4e-15);
}

TEST(Dopri5, ErrorFallsWithTheFifthPowerOfTheStep) {
  double errors[3];
  for (int i = 0; i < 3; ++i) errors[i] = start(1.0, 1.0, 0.5).step(0.1 / (1 << i)).error;
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 5.0, 0.15);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 5.0, 0.1);
}

TEST(Dopri5, TakesSixEvaluationsAStep) {
  OscillatorRun run = start(1.0, 1.0, 0.0);
  const int before = run.oscillator.accelerations;
  run.step(0.1);
  run.step(0.1);
  EXPECT_EQ(run.oscillator.accelerations - before, 12);
  EXPECT_TRUE(run.oscillator.stages.empty());
}

}  // namespace
}  // namespace freeplay::test
