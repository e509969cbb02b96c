#include "newmark_family.h"

namespace freeplay::test {
namespace {

TEST(GeneralizedAlpha, OneStepOfTheOscillator) {
  expect_one_step("generalized-alpha", {{"rho_inf", 0.8}}, {0.995012827090816, -0.0997460236018471, -0.99584402257568},
                  {-0.0590355919765166, -1.07531188845401, 0.46159491193738});
  expect_one_step("generalized-alpha", {{"rho_inf", 0.5}}, {0.995014771048744, -0.0997230428360414, -0.9966765140325},
                  {-0.0542025862068965, -1.05495689655172, 0.036206896551724});
  expect_one_step("generalized-alpha", {{"rho_inf", 0.0}}, {0.99502487562189, -0.0996268656716418, -0.99751243781095},
                  {-0.0318195093457944, -0.984667056074766, -0.45911214953271});
}

TEST(GeneralizedAlpha, SpectralRadiusDampsLargeSteps) {
  const struct {
    double rho, step_per_period, radius;
  } cases[] = {{0.8, 0.01, 0.999999989322879}, {0.8, 0.05, 0.999993509384038}, {0.8, 0.1, 0.999904421368317},
               {0.8, 0.2, 0.998852598252274},  {0.8, 1, 0.956279260236025},    {0.8, 10, 0.8464094523105},
               {0.0, 0.01, 0.999992328274011}, {0.0, 0.05, 0.996491091429211}, {0.0, 0.1, 0.96970816650844},
               {0.0, 0.2, 0.853873949874003},  {0.0, 1, 0.339225812616463},    {0.0, 10, 0.0658841733799527}};
  for (const auto& c : cases)
    EXPECT_NEAR(spectral_radius("generalized-alpha", {{"rho_inf", c.rho}}, c.step_per_period), c.radius, 1e-7);
}

TEST(GeneralizedAlpha, SpectralRadiusTendsToRho) {
  for (const double rho : {0.0, 0.3, 0.8, 1.0})
    EXPECT_NEAR(spectral_radius("generalized-alpha", {{"rho_inf", rho}}, 1e4), rho, 2e-2);
}

TEST(GeneralizedAlpha, IsOfSecondOrder) {
  for (const double rho : {0.0, 0.8, 1.0}) expect_order("generalized-alpha", {{"rho_inf", rho}}, 2.0);
}

// z' = -z, h = 0.3 from z = 2: two steps of the rule in rational arithmetic.
TEST(GeneralizedAlpha, InternalVariablesFollowTheRuleOfTheVelocity) {
  OscillatorRun run = family_run("generalized-alpha", {{"rho_inf", 0.5}}, {.decay = 1.0}, 0.0, 0.0, 2.0);
  run.step(0.3);
  EXPECT_NEAR(run.z[0], 1.4857142857142858, 1e-14);
  run.step(0.3);
  EXPECT_NEAR(run.z[0], 1.096326530612245, 1e-14);
}

// A_1 = k0 + k1 a_1 with the a_1 of the stage: the damping of the method is in it.
TEST(GeneralizedAlpha, AuxiliaryAccelerationKeepsThatOfTheStage) {
  OscillatorRun plain = family_run("generalized-alpha", {}, {}, 1.0, 0.0);
  OscillatorRun disturbed = family_run("generalized-alpha", {}, {}, 1.0, 0.0);
  plain.step(0.1);
  disturbed.oscillator.post_solve = 0.5;
  disturbed.step(0.1);
  EXPECT_EQ(disturbed.memory[0], plain.memory[0]);
  EXPECT_EQ(disturbed.a[0], plain.a[0] + 0.5);
}

TEST(GeneralizedAlpha, RestartForgetsTheAuxiliaryAcceleration) {
  OscillatorRun run = family_run("generalized-alpha", {}, {.decay = 2.0}, 1.0, 0.0, 3.0);
  run.step(0.5);
  EXPECT_NE(run.memory[0], run.a[0]);
  StateView s = run.state();
  const abi::StageSolverTable table = run.oscillator.table();
  run.integrator.call(&abi::IntegratorTable::restart, &s, &table);
  EXPECT_EQ(run.memory[0], run.a[0]);
  EXPECT_EQ(run.memory[1], -2.0 * run.z[0]);
  EXPECT_EQ(run.memory[2], -2.0 * run.z[0]);
}

TEST(GeneralizedAlpha, TableHoldsDefaultAndRange) {
  const Parameter& rho = integrator_parameter("generalized-alpha", "rho_inf");
  EXPECT_EQ(rho.default_value, 0.8);
  EXPECT_EQ(rho.minimum, 0.0);
  EXPECT_EQ(rho.maximum, 1.0);
  EXPECT_EQ(rho.open, Open::none);
}

TEST(GeneralizedAlpha, KeepsItsOrderWhereStepsVary) {
  expect_order_with_varying_steps("generalized-alpha", {{"rho_inf", 0.0}});
}

TEST(GeneralizedAlpha, HasOneStageAndProjectsVelocities) { expect_one_projected_stage("generalized-alpha"); }

TEST(GeneralizedAlpha, DeclaresWhatItNeedsAndPassesTheNewtonParameters) {
  expect_newton_parameters("generalized-alpha");
}

}  // namespace
}  // namespace freeplay::test
