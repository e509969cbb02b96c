#include <cmath>

#include "oscillator.h"

namespace freeplay::test {
namespace {

constexpr double optimal = -1.0;

ParameterStub parameters(double split, double rho) {
  ParameterStub stub(component(freeplay_plugin_v1_solvers, "bathe"));
  if (split == optimal) {
    stub.words["split"] = 0;
  } else {
    stub.numbers["split"] = split;
  }
  stub.numbers["rho_inf"] = rho;
  return stub;
}

struct Trial : OscillatorRun {
  Trial(double split, double rho, Oscillator model, double q0, double v0, double z0 = 0.0)
      : OscillatorRun("bathe", parameters(split, rho), model, q0, v0, z0) {}
};

// One step in double precision by the matrix recursion of the method, from consistent initial values.
TEST(Bathe, OneStepOfTheDampedOscillator) {
  const struct {
    double omega, zeta, q0, v0, h, split, rho, q, v, a;
  } cases[] = {{1.0, 0.0, 1.0, 0.0, 0.1, 0.5, 0.0, 0.995007975731039, -0.0997919585497688, -0.99500797573104},
               {1.0, 0.0, 1.0, 0.0, 0.1, optimal, 0.0, 0.995007832947154, -0.0997931746341209, -0.99500783294715},
               {1.0, 0.0, 1.0, 0.0, 0.1, optimal, 0.5, 0.995006914583094, -0.0998040774626316, -0.99500691458309},
               {1.0, 0.0, 1.0, 0.0, 0.1, 0.5, 1.0, 0.995006244145504, -0.0998126951417388, -0.9950062441455},
               {1.0, 0.0, 1.0, 0.0, 0.1, optimal, 1.0, 0.995006244145504, -0.0998126951417388, -0.9950062441455},
               {3.0, 0.05, 0.2, -1.0, 0.25, 0.5, 0.0, -0.0653050791135196, -1.07246747271287, 0.90948595383554},
               {3.0, 0.05, 0.2, -1.0, 0.25, optimal, 0.0, -0.0654598830376207, -1.07222060395382, 0.91080512852473},
               {3.0, 0.05, 0.2, -1.0, 0.25, optimal, 0.5, -0.0670238891769333, -1.07098259574874, 0.92450978131702},
               {3.0, 0.05, 0.2, -1.0, 0.25, 0.5, 1.0, -0.0682842794349492, -1.07016151766045, 0.93560697021268}};
  for (const auto& c : cases) {
    Trial run(c.split, c.rho, {.omega = c.omega, .zeta = c.zeta}, c.q0, c.v0);
    ASSERT_EQ(run.step(c.h).converged, 1);
    EXPECT_NEAR(run.q[0], c.q, 1e-13);
    EXPECT_NEAR(run.v[0], c.v, 1e-13);
    EXPECT_NEAR(run.a[0], c.a, 1e-13);
    EXPECT_EQ(run.t, c.h);
  }
}

// abs(R) of one step of the undamped oscillator; its 2 x 2 amplification matrix has the determinant abs(R)^2.
TEST(Bathe, SpectralRadiusDampsLargeSteps) {
  const struct {
    double split, rho, step_per_period, radius;
  } cases[] = {{0.5, 0.0, 0.01, 0.999999945920908},
               {0.5, 0.0, 0.1, 0.999493934337159},
               {0.5, 0.0, 0.2, 0.993272946041567},
               {0.5, 0.0, 1.0, 0.64846636770808},
               {0.5, 0.0, 10.0, 0.0793841811474615},
               {optimal, 0.0, 0.1, 0.999463321935721},
               {optimal, 0.0, 1.0, 0.635575314210254},
               {optimal, 0.0, 10.0, 0.076677104507046},
               {optimal, 0.5, 1.0, 0.768233340145411},
               {optimal, 0.5, 10.0, 0.505236783761441},
               {0.5, 1.0, 10.0, 1.0}};
  for (const auto& c : cases) {
    Trial first(c.split, c.rho, {}, 1.0, 0.0), second(c.split, c.rho, {}, 0.0, 1.0);
    const double h = 2.0 * M_PI * c.step_per_period;
    first.step(h);
    second.step(h);
    EXPECT_NEAR(std::sqrt(first.q[0] * second.v[0] - second.q[0] * first.v[0]), c.radius, 1e-12);
  }
}

// z' = -z by R(x) = (12 + 5x)/((4 - x)(3 - x)), closed form for split 1/2 and rho 0, at x = -h.
TEST(Bathe, InternalVariablesFollowTheSameRule) {
  Trial run(0.5, 0.0, {.decay = 1.0}, 0.0, 0.0, 2.0);
  const double x = -0.3, r = (12.0 + 5.0 * x) / ((4.0 - x) * (3.0 - x));
  run.step(0.3);
  EXPECT_NEAR(run.z[0], 2.0 * r, 1e-14);
  run.step(0.3);
  EXPECT_NEAR(run.z[0], 2.0 * r * r, 1e-14);
}

// Weights q0, q1, q2 of rho = 1/2 with the optimal split, evaluated in 34 digits; they differ from each other.
TEST(Bathe, InternalVariablesTakeTheWeightsOfBothStages) {
  const double s = 0.535898384862246, q0 = 0.299038105676658, q1 = 0.433012701892219, q2 = 0.267949192431123;
  Trial run(optimal, 0.5, {.decay = 1.0}, 0.0, 0.0, 2.0);
  run.step(0.3);
  const double x = -0.3, stage = (1.0 + 0.5 * s * x) / (1.0 - 0.5 * s * x);
  EXPECT_NEAR(run.z[0], 2.0 * (1.0 + x * (q0 + q1 * stage)) / (1.0 - q2 * x), 1e-14);
}

TEST(Bathe, StagesHoldPositionsAndThenVelocitiesAreProjected) {
  Trial run(0.4, 0.0, {}, 1.0, 0.0);
  run.t = 3.0;
  const int before = run.oscillator.accelerations;
  run.step(0.5);
  ASSERT_EQ(run.oscillator.stages.size(), 2u);
  for (const Stage& s : run.oscillator.stages) EXPECT_EQ(s.level, ConstraintLevel::position);
  EXPECT_EQ(run.oscillator.stages[0].t, 3.0 + 0.4 * 0.5);
  EXPECT_EQ(run.oscillator.stages[1].t, 3.5);
  EXPECT_EQ(run.oscillator.guesses[0], -1.0);  // a at the start of the step
  EXPECT_EQ(run.oscillator.projections, 1);
  EXPECT_EQ(run.oscillator.accelerations, before + 1);
}

// The accelerations of the first stage are off those of the motion by a third of their change, in every step alike.
TEST(Bathe, GuessesStagesFromThoseOfTheStepsBefore) {
  Trial run(0.5, 0.0, {}, 1.0, 0.0);
  for (int step = 0; step < 8; ++step) run.step(0.01);
  const double a = run.a[0];
  run.step(0.01);
  const std::size_t last = run.oscillator.guesses.size() - 1;
  for (const std::size_t stage : {last - 1, last}) {
    const double moved = run.oscillator.solutions[stage] - a;
    EXPECT_NEAR(run.oscillator.guesses[stage], run.oscillator.solutions[stage], 1e-3 * std::abs(moved)) << stage;
  }
}

// What smooth steps may leave of the velocities of their stages: half of what is allowed, in each.
constexpr double allowed = 1e-8, short_step = 1e-3;

struct UnsolvedStages : ::testing::Test {
  explicit UnsolvedStages(Oscillator model = {.zeta = 0.05, .internal = false})
      : allowing([&] {
          Oscillator telling = model;
          telling.allowed = allowed;
          return telling;
        }()),
        run(0.5, 0.0, allowing, 1.0, 0.0),
        full(0.5, 0.0, model, 1.0, 0.0) {}
  /// Stages that are solved in one more step.
  std::size_t step() {
    const std::size_t before = run.oscillator.stages.size();
    run.step(short_step);
    full.step(short_step);
    ++steps;
    return run.oscillator.stages.size() - before;
  }
  /// Goes on to a step whose stages are left as predicted.
  void reach_unsolved_step() {
    int i = 0;
    while (step() != 0 && i < 100) ++i;
    ASSERT_LT(i, 100);
  }
  void expect_alike() const {
    const double v = 0.5 * allowed * steps;
    EXPECT_NEAR(run.v[0], full.v[0], v);
    EXPECT_NEAR(run.q[0], full.q[0], v * short_step * steps);
  }
  Oscillator allowing;
  Trial run, full;
  int steps = 0;
};

TEST_F(UnsolvedStages, AreMostOfASmoothMotion) {
  for (int i = 0; i < 10; ++i) step();
  std::size_t stages = 0;
  for (int i = 0; i < 320; ++i) stages += step();
  EXPECT_GT(stages, 0u);
  EXPECT_LE(stages, 320u / 4u);  // of 640 at two a step
  expect_alike();
  EXPECT_NE(run.v[0], full.v[0]);
}

TEST_F(UnsolvedStages, EndInAccelerationsOfTheStateOfTheStep) {
  for (int i = 0; i < 40; ++i) {
    step();
    EXPECT_EQ(run.a[0], run.oscillator.acceleration(run.q[0], run.v[0], run.t)) << i;
    EXPECT_EQ(run.t, full.t);
  }
}

TEST_F(UnsolvedStages, AreSolvedInAStepThatIsNotAsPredicted) {
  reach_unsolved_step();
  for (Trial* both : {&run, &full}) {
    both->oscillator.push = 3.0;
    both->oscillator.push_from = both->t + 0.3 * short_step;
  }
  const double v = full.v[0], q = full.q[0];
  EXPECT_EQ(step(), 2u);
  EXPECT_NEAR(run.v[0] - v, full.v[0] - v, allowed * steps);
  EXPECT_NEAR(run.q[0] - q, full.q[0] - q, allowed * steps * short_step);
  expect_alike();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(step(), 2u);  // for a while every stage is solved
  reach_unsolved_step();
  expect_alike();
}

TEST_F(UnsolvedStages, AreSolvedAgainAfterOtherStepsAndRestarts) {
  for (int i = 0; i < 40; ++i) step();
  reach_unsolved_step();
  std::size_t before = run.oscillator.stages.size();
  run.step(0.9 * short_step);
  EXPECT_EQ(run.oscillator.stages.size(), before + 2);
  for (int i = 0; i < 40; ++i) step();
  reach_unsolved_step();
  StateView state = run.state();
  const abi::StageSolverTable table = run.oscillator.table();
  run.integrator.call(&abi::IntegratorTable::restart, &state, &table);
  EXPECT_EQ(step(), 2u);
}

// As multipliers that hold positions in a stage and accelerations at the end of a step.
TEST(Bathe, WhatAccelerationsAtTheEndAlwaysDifferByIsNoSurprise) {
  Trial run(0.5, 0.0, {.zeta = 0.05, .post_solve = 0.01, .allowed = allowed, .internal = false}, 1.0, 0.0);
  for (int i = 0; i < 10; ++i) run.step(short_step);
  const std::size_t before = run.oscillator.stages.size();
  for (int i = 0; i < 320; ++i) run.step(short_step);
  EXPECT_LE(run.oscillator.stages.size() - before, 320u / 4u);  // of 640 at two a step
}

TEST(Bathe, EveryStageIsSolvedWhereNoUnsolvedStepsAreAllowed) {
  ParameterStub stub = parameters(0.5, 0.0);
  stub.numbers["unsolved_steps"] = 0;
  OscillatorRun run("bathe", stub, {.zeta = 0.05, .allowed = allowed, .internal = false}, 1.0, 0.0, 0.0);
  for (int i = 0; i < 50; ++i) run.step(short_step);
  EXPECT_EQ(run.oscillator.stages.size(), 100u);
}

TEST(Bathe, EveryStageIsSolvedWhereInternalVariablesOrErrorsNeedIt) {
  for (const bool errors : {false, true}) {
    Trial run(0.5, 0.0, {.estimates = errors, .allowed = allowed, .internal = !errors}, 1.0, 0.0);
    for (int i = 0; i < 50; ++i) run.step(short_step);
    EXPECT_EQ(run.oscillator.stages.size(), 100u) << errors;
  }
}

// At rest nothing tells how stiff a motion is, until something disturbs it.
TEST(Bathe, StiffMotionsStayDampedWhereStagesAreLeftAsPredicted) {
  Trial run(0.5, 0.0,
            {.omega = 1e4, .zeta = 0.01, .allowed = allowed, .push = 1.0, .push_from = 0.0, .internal = false}, 1e-8,
            0.0);
  std::size_t unsolved = 0;
  const auto step = [&] {
    const std::size_t before = run.oscillator.stages.size();
    run.step(0.05);
    unsolved += run.oscillator.stages.size() == before ? 1 : 0;
  };
  for (int i = 0; i < 500; ++i) {
    step();
    ASSERT_NEAR(run.v[0], 0.0, allowed) << i;
    ASSERT_NEAR(run.q[0], 1e-8, 0.05 * allowed) << i;
  }
  EXPECT_GT(unsolved, 400u);
  run.oscillator.push = 2.0;
  for (int i = 0; i < 500; ++i) {
    step();
    if (i < 20) continue;
    ASSERT_NEAR(run.v[0], 0.0, allowed) << i;
    ASSERT_NEAR(run.q[0], 2e-8, 0.05 * allowed) << i;
  }
}

// Each try that fails costs a step's end. Between them the first stage alone is left as predicted.
TEST(Bathe, WhatIsNeverAsPredictedIsSeldomTried) {
  const Oscillator silent{.zeta = 0.05, .stages_to_converge = 10000, .internal = false};
  Oscillator off = silent;
  off.allowed = allowed;
  off.off_rows = 2.0;
  Trial run(0.5, 0.0, off, 1.0, 0.0), full(0.5, 0.0, silent, 1.0, 0.0);
  int tries = 0;
  for (int i = 0; i < 3000; ++i) {
    const int before = run.oscillator.accelerations;
    run.step(short_step);
    full.step(short_step);
    tries += run.oscillator.accelerations - before - 1;
  }
  EXPECT_GT(tries, 5);
  EXPECT_LE(tries, 14);
  EXPECT_GE(run.oscillator.stages.size(), 3000u * 17 / 16);
  EXPECT_LE(run.oscillator.stages.size(), 3000u * 18 / 16);
  const double v = 0.5 * allowed * 3000;
  EXPECT_NEAR(run.v[0], full.v[0], v);
  EXPECT_NEAR(run.q[0], full.q[0], v * short_step * 3000);
}

TEST(Bathe, AFirstStageLeftAloneIsSolvedWhereTheEndIsASurprise) {
  Oscillator off{.zeta = 0.05, .stages_to_converge = 10000, .internal = false};
  Trial full(0.5, 0.0, off, 1.0, 0.0);
  off.allowed = allowed;
  off.off_rows = 2.0;
  Trial run(0.5, 0.0, off, 1.0, 0.0);
  std::size_t solved = 2;
  const auto step = [&] {
    const std::size_t before = run.oscillator.stages.size();
    run.step(short_step);
    full.step(short_step);
    solved = run.oscillator.stages.size() - before;
  };
  for (int i = 0; i < 500 || solved != 1; ++i) step();  // far from the next try
  for (Trial* both : {&run, &full}) {
    both->oscillator.push = 3.0;
    both->oscillator.push_from = both->t + 0.3 * short_step;
  }
  const double v = full.v[0] - run.v[0];
  step();
  EXPECT_EQ(solved, 3u);  // the end, the first stage, the end again
  EXPECT_NEAR(full.v[0] - run.v[0], v, allowed);
  step();
  EXPECT_EQ(solved, 2u);
}

TEST(Bathe, OptimalSplitGivesBothStagesOneMatrix) {
  for (const double rho : {0.0, 0.3, 1.0}) {
    Trial run(optimal, rho, {}, 1.0, 0.0);
    run.step(0.1);
    EXPECT_EQ(run.oscillator.stages[0].beta_q, run.oscillator.stages[1].beta_q);
    EXPECT_EQ(run.oscillator.stages[0].beta_v, run.oscillator.stages[1].beta_v);
  }
}

// q1 = (rho + 1)/(2 s (rho - 1) + 4), q2 = 1/2 - s q1.
TEST(Bathe, SecondStageWeighsAsPublishedForAnySplit) {
  for (const double split : {1e-6, 0.2, 0.9, 1.0 - 1e-9})
    for (const double rho : {0.0, 0.7, 1.0}) {
      Trial run(split, rho, {}, 1.0, 0.0);
      run.step(1.0);
      const double q1 = (rho + 1.0) / (2.0 * split * (rho - 1.0) + 4.0);
      EXPECT_NEAR(run.oscillator.stages[1].beta_v, 0.5 - split * q1, 1e-15);
      EXPECT_GT(run.oscillator.stages[1].beta_v, 0.0);
    }
}

TEST(Bathe, IsOfSecondOrder) {
  const auto error = [](int steps) {
    Trial run(0.5, 0.0, {.omega = 2.0, .zeta = 0.1}, 1.0, 0.0);
    for (int i = 0; i < steps; ++i) run.step(1.0 / steps);
    // q = exp(-zeta omega t)(cos w t + zeta omega/w sin w t), w = omega sqrt(1 - zeta^2)
    const double w = 2.0 * std::sqrt(0.99);
    return std::abs(run.q[0] - std::exp(-0.2) * (std::cos(w) + 0.2 / w * std::sin(w)));
  };
  EXPECT_NEAR(std::log2(error(100) / error(200)), 2.0, 0.05);
}

TEST(Bathe, GivesUpWithTheStageThatDoesNotConverge) {
  for (const int good : {0, 1}) {
    Trial run(0.5, 0.0, {.stages_to_converge = good}, 1.0, 0.0);
    EXPECT_EQ(run.step(0.1).converged, 0);
    EXPECT_EQ(static_cast<int>(run.oscillator.stages.size()), good + 1);
    EXPECT_EQ(run.oscillator.projections, 0);
  }
}

TEST(Bathe, DeclaresWhatItNeedsAndPassesTheNewtonParameters) {
  ParameterStub stub = parameters(0.5, 0.0);
  stub.numbers["newton.tolerance"] = 1e-8;
  stub.numbers["newton.max_iterations"] = 7;
  const IntegratorInstance integrator(component(freeplay_plugin_v1_solvers, "bathe"), stub);
  IntegratorLayout layout;
  layout.sizes = {7, 6, 2, 3};
  integrator.call(&abi::IntegratorTable::declare, &layout);
  EXPECT_EQ(layout.order, 2);
  EXPECT_EQ(layout.newton_tolerance, 1e-8);
  EXPECT_EQ(layout.newton_max_iterations, 7);
}

}  // namespace
}  // namespace freeplay::test
