// NewtonStageSolver: what a stage leaves behind.
#include "stage/newton_stage_solver.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

/// A body on a spring that swings about its other end.
constexpr const char* swinging = R"(freeplay: 1
bodies:
  ball: {mass: 0.5, inertia: 1e-3, frames: {eye: [0.05, 0]}, pose: {position: [0.3, 0.1]}}
joints:
  spring: {type: spring-damper, between: [ground, ball/eye], stiffness: 2000, damping: 3, free_length: 0.2}
)";

struct Swinging : ::testing::Test {
  Swinging() : model(test::load(swinging)), system(*model), state(assemble(system).state), before(state) {
    context.profile = &profile;
    solver.use_history(state.h());
    const double v[] = {0.0, 1.5, 2.0};
    std::ranges::copy(v, before.v().begin());
    StateView view = before.view();
    EXPECT_TRUE(solver.accelerate(view, {}));
    state = before;
  }
  StageResult trapezoid(double b) { return trapezoid(b, solver, state); }
  /// v = v_0 + b (a_0 + a), d = b (v_0 + v): the trapezoidal rule.
  StageResult trapezoid(double b, NewtonStageSolver& own, State& to) {
    std::vector<double> v_known(before.v().begin(), before.v().end()), known(v_known.size());
    for (std::size_t i = 0; i < v_known.size(); ++i) {
      v_known[i] += b * before.a()[i];
      known[i] = b * (before.v()[i] + v_known[i]);
    }
    const Stage stage{.t = before.t() + 2.0 * b,
                      .q_base = std::span<const double>(before.q()),
                      .increment_known = std::span<const double>(known),
                      .v_known = std::span<const double>(v_known),
                      .z_known = {},
                      .beta_q = b * b,
                      .beta_v = b,
                      .beta_z = b,
                      .level = ConstraintLevel::position};
    own.use_history(to.h());
    StateView view = to.view();
    StageResult result{};
    EXPECT_TRUE(own.solve(stage, view, result));
    return result;
  }
  std::shared_ptr<const Model> model;
  System system;
  Profile profile;
  EvaluationContext context;
  NewtonStageSolver solver{system, {}, &context};
  State state, before;
};

TEST_F(Swinging, EvaluatesTheEndOfAStageWithoutRowsLast) {
  const StageResult result = trapezoid(1e-4);
  ASSERT_TRUE(result.converged);
  ASSERT_GT(result.iterations, 1);
  const std::vector<double> left(state.a().begin(), state.a().end());
  const long looks = profile.count(Phase::assembly);
  StateView view = state.view();
  ASSERT_TRUE(solver.accelerate(view, {}));
  EXPECT_EQ(looks, profile.count(Phase::assembly));
  for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], state.a()[i], 1e-6) << i;
}

TEST_F(Swinging, StageHoldsItsFormulas) {
  const double b = 1e-3;
  ASSERT_TRUE(trapezoid(b).converged);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(before.v()[i] + b * before.a()[i] + b * state.a()[i], state.v()[i]) << i;
    EXPECT_NEAR(before.q()[i] + b * (before.v()[i] + state.v()[i]), state.q()[i], 1e-15) << i;
  }
}

TEST_F(Swinging, WhatAStageLeavesIsWithinTheTolerance) {
  for (const double b : {1e-2, 1e-3, 1e-4, 1e-5}) {
    NewtonStageSolver usual(system, {}), exact(system, {.tolerance = 1e-16});
    State loose = before, sharp = before;
    ASSERT_TRUE(trapezoid(b, usual, loose).converged) << b;
    ASSERT_TRUE(trapezoid(b, exact, sharp).converged) << b;
    const double allowed = ConvergenceParameters{}.tolerance * system.size();
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(sharp.q()[i], loose.q()[i], allowed) << b;
      EXPECT_NEAR(sharp.v()[i], loose.v()[i], allowed * std::max(1.0, 1.0 / (5000.0 * b))) << b;
    }
  }
}

}  // namespace
}  // namespace freeplay
