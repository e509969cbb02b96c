#include <cmath>
#include <complex>
#include <ostream>
#include <vector>

#include "oscillator.h"

namespace freeplay::test {
namespace {

/// An embedded pair and what is known of it.
struct Pair {
  const char* name;
  /// R(z) = 1 + z/d_1 (1 + z/d_2 (1 + ...)): of a method of order p the first p are 1 to p.
  std::vector<double> divisors;
  int order, evaluations;
  double digits;    // rounding of q after one step
  double longest;   // step of the first error [s]
  double apart[2];  // by which the order that is seen may miss
};

std::ostream& operator<<(std::ostream& out, const Pair& pair) { return out << pair.name; }

// The last divisor of dopri5: Hairer and Wanner, Solving ODEs II, IV.2; of verner6: b^T A^6 1 of its tableau in
// rational numbers is 1/5400, b^T A^7 1 = 0; of verner7: b^T A^7 1 = 1/39717.69787874202 of the table of 40 digits,
// b^T A^8 1 = 1/338143.5098439531, b^T A^9 1 = 0.
const Pair pairs[] = {{"dopri5", {1, 2, 3, 4, 5, 5}, 5, 6, 2e-15, 0.1, {0.15, 0.1}},
                      {"verner6", {1, 2, 3, 4, 5, 6, 7.5}, 6, 8, 4e-15, 0.2, {0.3, 0.2}},
                      {"verner7",
                       {1, 2, 3, 4, 5, 6, 7, 39717.69787874202 / 5040.0, 338143.5098439531 / 39717.69787874202},
                       7,
                       10,
                       2e-14,
                       0.4,
                       {0.3, 0.2}}};

class ExplicitRungeKutta : public testing::TestWithParam<Pair> {
 protected:
  static OscillatorRun start(double omega, double q0, double v0, double z0 = 0.0, double decay = 0.0) {
    return OscillatorRun(GetParam().name, ParameterStub(component(freeplay_plugin_v1_solvers, GetParam().name)),
                         {.omega = omega, .decay = decay, .estimates = true}, q0, v0, z0);
  }
  template <class Number>
  static Number stability(Number z) {
    Number r = 1.0;
    for (std::size_t i = GetParam().divisors.size(); i-- > 0;) r = 1.0 + z / GetParam().divisors[i] * r;
    return r;
  }
};

// With w = q + i v/omega the oscillator is w' = -i omega w.
TEST_P(ExplicitRungeKutta, OneStepIsItsStabilityFunction) {
  for (const double h : {0.1, 0.4, 1.0}) {
    constexpr double omega = 1.5, q0 = 0.3, v0 = -0.7;
    OscillatorRun run = start(omega, q0, v0);
    run.step(h);
    const std::complex<double> w =
        stability(std::complex<double>(0.0, -omega * h)) * std::complex<double>(q0, v0 / omega);
    EXPECT_NEAR(run.q[0], w.real(), GetParam().digits) << h;
    EXPECT_NEAR(run.v[0], omega * w.imag(), 2.0 * GetParam().digits) << h;
    EXPECT_NEAR(run.a[0], -omega * omega * run.q[0], 1e-14) << h;
    EXPECT_EQ(run.t, h);
  }
}

TEST_P(ExplicitRungeKutta, InternalVariablesFollowTheSameRule) {
  OscillatorRun run = start(1.0, 0.0, 0.0, 2.0, 3.0);
  run.step(0.2);
  EXPECT_NEAR(run.z[0], 2.0 * stability(-0.6), 4e-15);
}

TEST_P(ExplicitRungeKutta, ErrorFallsWithItsPowerOfTheStep) {
  double errors[3];
  for (int i = 0; i < 3; ++i) errors[i] = start(1.0, 1.0, 0.5).step(GetParam().longest / (1 << i)).error;
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), GetParam().order, GetParam().apart[0]);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), GetParam().order, GetParam().apart[1]);
}

// Where q'' = 2 q q' all conditions of its order count, not only those of linear equations.
TEST_P(ExplicitRungeKutta, LocalErrorFallsWithThePowerAfterItsOrder) {
  const auto local_error = [](double h) {
    OscillatorRun run(GetParam().name, ParameterStub(component(freeplay_plugin_v1_solvers, GetParam().name)),
                      {.omega = 0.0, .bent = true}, std::tan(0.5), 1.0 + std::tan(0.5) * std::tan(0.5));
    run.step(h);
    return std::abs(run.q[0] - std::tan(0.5 + h));
  };
  const double h = 0.5 * GetParam().longest;
  EXPECT_NEAR(std::log2(local_error(h) / local_error(0.5 * h)), GetParam().order + 1, 0.7);
}

TEST_P(ExplicitRungeKutta, TakesOneEvaluationForEachStageAndNoIteration) {
  OscillatorRun run = start(1.0, 1.0, 0.0);
  const int before = run.oscillator.accelerations;
  run.step(0.1);
  run.step(0.1);
  EXPECT_EQ(run.oscillator.accelerations - before, 2 * GetParam().evaluations);
  EXPECT_TRUE(run.oscillator.stages.empty());
}

INSTANTIATE_TEST_SUITE_P(Pairs, ExplicitRungeKutta, testing::ValuesIn(pairs),
                         [](const auto& pair) { return std::string(pair.param.name); });

}  // namespace
}  // namespace freeplay::test
