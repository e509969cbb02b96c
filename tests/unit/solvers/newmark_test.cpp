#include "newmark_family.h"

namespace freeplay::test {
namespace {

TEST(Newmark, OneStepOfTheOscillator) {
  expect_one_step("newmark", {}, {0.99501246882793, -0.0997506234413965, -0.99501246882793},
                  {-0.059946949602122, -1.07957559681698, 0.86339522546419});
}

TEST(Newmark, TrapezoidalRuleKeepsTheAmplitude) {
  for (const double step_per_period : {0.01, 0.1, 0.2, 1.0, 10.0})
    EXPECT_NEAR(spectral_radius("newmark", {}, step_per_period), 1.0, 1e-12);
}

TEST(Newmark, IsOfSecondOrderWithoutDampingElseOfFirst) {
  expect_order("newmark", {}, 2.0);
  expect_order("newmark", {{"beta", 1.0 / 6.0}}, 2.0);
  expect_order("newmark", {{"beta", 0.36}, {"gamma", 0.7}}, 1.0);
}

// For h -> infinity and beta = (gamma + 1/2)^2/4 there is the double eigenvalue -(3/2 - gamma)/(1/2 + gamma), which a
// step of 1e6 radians reaches to the root of its inverse.
TEST(Newmark, DampsLargeStepsWithGammaAboveOneHalf) {
  EXPECT_NEAR(spectral_radius("newmark", {{"beta", 0.36}, {"gamma", 0.7}}, 1e5), 0.8 / 1.2, 2e-3);
}

// z' = -z by the trapezoidal rule: R(x) = (1 + x/2)/(1 - x/2) at x = -h.
TEST(Newmark, InternalVariablesFollowTheRuleOfTheVelocity) {
  OscillatorRun run = family_run("newmark", {}, {.decay = 1.0}, 0.0, 0.0, 2.0);
  const double r = 0.85 / 1.15;
  run.step(0.3);
  EXPECT_NEAR(run.z[0], 2.0 * r, 1e-15);
  run.step(0.3);
  EXPECT_NEAR(run.z[0], 2.0 * r * r, 1e-15);
}

// Otherwise what disturbs the stage across a constraint would alternate for ever.
TEST(Newmark, NextStepStartsFromTheAccelerationSolvedAtTheEnd) {
  OscillatorRun run = family_run("newmark", {}, {.post_solve = 0.5}, 1.0, 0.0);
  run.step(0.1);
  EXPECT_EQ(run.memory[0], run.a[0]);
  EXPECT_EQ(run.a[0], -run.q[0] + 0.5);
}

TEST(Newmark, TableHoldsTheTrapezoidalRule) {
  EXPECT_EQ(integrator_parameter("newmark", "beta").default_value, 0.25);
  EXPECT_EQ(integrator_parameter("newmark", "gamma").default_value, 0.5);
}

TEST(Newmark, HasOneStageAndProjectsVelocities) { expect_one_projected_stage("newmark"); }

TEST(Newmark, DeclaresWhatItNeedsAndPassesTheNewtonParameters) { expect_newton_parameters("newmark"); }

}  // namespace
}  // namespace freeplay::test
