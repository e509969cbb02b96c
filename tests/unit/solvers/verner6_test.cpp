#include <cmath>
#include <complex>

#include "oscillator.h"

namespace freeplay::test {
namespace {

OscillatorRun start(double omega, double q0, double v0, double z0 = 0.0, double decay = 0.0) {
  return OscillatorRun("verner6", ParameterStub(component(freeplay_plugin_v1_solvers, "verner6")),
                       {.omega = omega, .decay = decay, .estimates = true}, q0, v0, z0);
}

// R(z) of order 6 with z^7/5400 (b^T A^6 1 of the tableau in rational numbers; b^T A^7 1 = 0); with w = q + i v/omega
// the oscillator is w' = -i omega w.
template <class Number>
Number stability(Number z) {
  return 1.0 +
         z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0 * (1.0 + z / 6.0 * (1.0 + z / 7.5))))));
}

TEST(Verner6, OneStepIsItsStabilityFunction) {
  for (const double h : {0.1, 0.4, 1.0}) {
    constexpr double omega = 1.5, q0 = 0.3, v0 = -0.7;
    OscillatorRun run = start(omega, q0, v0);
    run.step(h);
    const std::complex<double> w =
        stability(std::complex<double>(0.0, -omega * h)) * std::complex<double>(q0, v0 / omega);
    EXPECT_NEAR(run.q[0], w.real(), 4e-15) << h;
    EXPECT_NEAR(run.v[0], omega * w.imag(), 8e-15) << h;
    EXPECT_NEAR(run.a[0], -omega * omega * run.q[0], 1e-14) << h;
  }
}

TEST(Verner6, InternalVariablesFollowTheSameRule) {
  OscillatorRun run = start(1.0, 0.0, 0.0, 2.0, 3.0);
  run.step(0.2);
  EXPECT_NEAR(run.z[0], 2.0 * stability(-0.6), 4e-15);
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
