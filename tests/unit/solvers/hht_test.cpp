#include "newmark_family.h"

namespace freeplay::test {
namespace {

TEST(Hht, OneStepOfTheOscillator) {
  expect_one_step("hht", {{"alpha", -0.1}}, {0.995013575540591, -0.0997307330791919, -0.99551221798653},
                  {-0.0571830861466365, -1.06008894794026, 0.59940701373162});
  expect_one_step("hht", {{"alpha", -0.3}}, {0.995014743894931, -0.0997208256581161, -0.99651032072645},
                  {-0.0542821814185039, -1.05240350423482, 0.11298247882589});
  expect_one_step("hht", {{"alpha", 0.0}}, {0.99501246882793, -0.0997506234413965, -0.99501246882793},
                  {-0.059946949602122, -1.07957559681698, 0.86339522546419});
}

TEST(Hht, SpectralRadiusDampsLargeSteps) {
  const struct {
    double step_per_period, radius;
  } cases[] = {{0.01, 0.999999842561024}, {0.05, 0.999906808656417}, {0.1, 0.998727782025083},
               {0.2, 0.987832151218381},  {1, 0.860918203464645},    {10, 0.818739282558242}};
  for (const auto& c : cases)
    EXPECT_NEAR(spectral_radius("hht", {{"alpha", -0.1}}, c.step_per_period), c.radius, 1e-11);
}

TEST(Hht, IsOfSecondOrder) {
  expect_order("hht", {}, 2.0);
  expect_order("hht", {{"alpha", -0.3}}, 2.0);
}

// z' = -z, h = 0.3 from z = 2: two steps of the rule in rational arithmetic.
TEST(Hht, InternalVariablesFollowTheRuleOfTheVelocity) {
  OscillatorRun run = family_run("hht", {{"alpha", -0.1}}, {.decay = 1.0}, 0.0, 0.0, 2.0);
  run.step(0.3);
  EXPECT_NEAR(run.z[0], 1.4836488812392428, 1e-14);
  run.step(0.3);
  EXPECT_NEAR(run.z[0], 1.0952746318443185, 1e-14);
}

// A_1 = k0 + k1 a_1 with the a_1 of the stage: the damping of the method is in it.
TEST(Hht, AuxiliaryAccelerationKeepsThatOfTheStage) {
  OscillatorRun plain = family_run("hht", {}, {}, 1.0, 0.0);
  OscillatorRun disturbed = family_run("hht", {}, {}, 1.0, 0.0);
  plain.step(0.1);
  disturbed.oscillator.post_solve = 0.5;
  disturbed.step(0.1);
  EXPECT_EQ(disturbed.memory[0], plain.memory[0]);
  EXPECT_EQ(disturbed.a[0], plain.a[0] + 0.5);
}

TEST(Hht, RestartForgetsTheAuxiliaryAcceleration) {
  OscillatorRun run = family_run("hht", {}, {.decay = 2.0}, 1.0, 0.0, 3.0);
  run.step(0.5);
  EXPECT_NE(run.memory[0], run.a[0]);
  StateView s = run.state();
  const abi::StageSolverTable table = run.oscillator.table();
  run.integrator.call(&abi::IntegratorTable::restart, &s, &table);
  EXPECT_EQ(run.memory[0], run.a[0]);
  EXPECT_EQ(run.memory[1], -2.0 * run.z[0]);
  EXPECT_EQ(run.memory[2], -2.0 * run.z[0]);
}

TEST(Hht, KeepsItsOrderWhereStepsVary) { expect_order_with_varying_steps("hht", {{"alpha", -0.3}}); }

TEST(Hht, HasOneStageAndProjectsVelocities) { expect_one_projected_stage("hht"); }

TEST(Hht, DeclaresWhatItNeedsAndPassesTheNewtonParameters) { expect_newton_parameters("hht"); }

}  // namespace
}  // namespace freeplay::test
