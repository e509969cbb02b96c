// ConvergenceMonitor: what the sizes of updates say of an iteration.
#include "stage/convergence_monitor.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

constexpr double eps = ConvergenceParameters::rounding;
constexpr double tau = 1e-10;

/// Stages of one Jacobian whose coordinates are of the size of the model. In a step of 1 ms both tolerances are tau.
struct Monitor : ::testing::Test {
  Monitor() { record.usable = true; }
  void begin(double beta_q = 1e-6, double beta_v = 1e-3) { monitor.begin(beta_q, beta_v, record); }
  void begin_fresh(double beta_q = 1e-6, double beta_v = 1e-3) {
    begin(beta_q, beta_v);
    monitor.jacobian_renewed();
  }
  Convergence judge(double size, bool internal_converged = true) {
    monitor.forces_act(acting);
    return monitor.judge(size, eps, internal_converged);
  }
  JacobianRecord record;
  ConvergenceMonitor monitor{{.tolerance = tau}};
  std::uint64_t acting = 0;
};
// Rounding floor: with these betas updates up to 50 eps / beta_q = 1.1e-8 move positions by roundings alone, and are
// far above the tolerance in velocity.
constexpr double noisy_q = 1e-6, noisy_v = 0.1;

TEST_F(Monitor, ConvergesWhereTheRestOfTheSeriesIsWithinTheTolerance) {
  begin();
  EXPECT_EQ(Convergence::contracting, judge(1.0));
  EXPECT_EQ(Convergence::contracting, judge(1e-2));
  // r = 0.01: 1.01e-6 1/s^2 is left, in 1 ms 1.01e-9 of velocity; then 1.01e-11.
  EXPECT_EQ(Convergence::contracting, judge(1e-4));
  EXPECT_EQ(Convergence::converged, judge(1e-6));
}

TEST_F(Monitor, JudgesPositionsByTheToleranceAlone) {
  begin(1.0, 1e-3);
  judge(1e-2);
  EXPECT_EQ(Convergence::contracting, judge(1e-6));  // r = 1e-4: 1.0001e-10 of position
  begin(1.0, 1e-3);
  judge(1e-2);
  EXPECT_EQ(Convergence::converged, judge(0.9e-6));
}

TEST_F(Monitor, HalvesWhatAFirstUpdateLeavesWhereNoRateIsKnown) {
  begin();
  EXPECT_EQ(Convergence::converged, judge(1e-7));  // 1/2 / (1 - 1/2): as much again
  begin();
  EXPECT_EQ(Convergence::contracting, judge(1.01e-7));
}

TEST_F(Monitor, DoesNotTrustTheFirstUpdateOfOtherForces) {
  acting = 1;
  begin();
  EXPECT_EQ(Convergence::contracting, judge(1e-9));
  EXPECT_EQ(Convergence::converged, judge(1e-12));
  begin();  // the same forces again
  EXPECT_EQ(Convergence::converged, judge(1e-9));
}

TEST_F(Monitor, RemembersTenTimesARate) {
  record.rate = 0.015;
  begin();
  judge(1e-4);
  judge(1e-7);
  EXPECT_DOUBLE_EQ(1e-2, record.rate);
}

TEST_F(Monitor, ForgetsABadRateByHalves) {
  ASSERT_EQ(1.0, record.rate);
  for (const double remembered : {0.5, 0.25, 0.125}) {
    begin();
    judge(1e-4);
    judge(1e-8);
    EXPECT_DOUBLE_EQ(remembered, record.rate);
  }
}

TEST_F(Monitor, MeasuresNoRateOfRounding) {
  begin();
  judge(8.0 * eps / 1e-6 * 0.99);
  judge(1e-12);
  EXPECT_EQ(1.0, record.rate);
}

TEST_F(Monitor, LetsARateStandForTheFirstUpdatesOfEightStages) {
  record.rate = 1e-2;
  for (int stage = 0; stage < 8; ++stage) {
    begin();
    EXPECT_EQ(Convergence::converged, judge(5e-6)) << stage;  // 5.05e-8 is left
  }
  begin();
  EXPECT_EQ(Convergence::contracting, judge(5e-6));
}

TEST_F(Monitor, LetsARateStandForSmallFirstUpdatesAlone) {
  record.rate = 1e-5;
  begin();
  EXPECT_EQ(Convergence::converged, judge(0.99e-5));  // 99 tolerances of velocity
  begin();
  EXPECT_EQ(Convergence::contracting, judge(1.01e-5));
}

TEST_F(Monitor, ForgetsRateAndNoiseWithOtherForces) {
  record.rate = 1e-3;
  record.noise = 1e-8;
  acting = 1;
  begin();
  judge(1e-6);
  EXPECT_EQ(1.0, record.rate);
  EXPECT_EQ(0.0, record.noise);
}

TEST_F(Monitor, RenewsAStaleJacobianAfterTheSecondUpdate) {
  begin();
  EXPECT_EQ(Convergence::contracting, judge(1.0));
  EXPECT_FALSE(monitor.needs_jacobian());
  EXPECT_EQ(Convergence::stale_jacobian, judge(0.11));
  EXPECT_TRUE(monitor.needs_jacobian());
  EXPECT_TRUE(record.usable);  // of a stage that is given up here the next one may use it
  monitor.jacobian_renewed();
  EXPECT_FALSE(monitor.needs_jacobian());
}

TEST_F(Monitor, KeepsAJacobianThatContractsByTen) {
  begin();
  judge(1.0);
  EXPECT_EQ(Convergence::contracting, judge(0.09));
  EXPECT_FALSE(monitor.needs_jacobian());
}

TEST_F(Monitor, NeedsAJacobianWhereThereIsNone) {
  record.begin();
  begin();
  EXPECT_TRUE(monitor.needs_jacobian());
}

TEST_F(Monitor, GoesOverToFullNewtonWhereNewFactorsContractSlowly) {
  begin_fresh();
  judge(1.0);
  EXPECT_EQ(Convergence::contracting, judge(0.2));
  EXPECT_EQ(Convergence::contracting, judge(0.04));
  EXPECT_EQ(Convergence::stale_jacobian, judge(0.008));
  EXPECT_FALSE(record.usable);
}

TEST_F(Monitor, StagnatesWhereNewFactorsHardlyContract) {
  begin_fresh();
  judge(1.0);
  EXPECT_EQ(Convergence::stagnated, judge(0.3));
  EXPECT_EQ(Convergence::contracting, monitor.go_on());
  EXPECT_EQ(Convergence::contracting, judge(0.08));
}

TEST_F(Monitor, DivergesWhenUpdatesDoubleTwice) {
  begin_fresh();
  judge(1.0);
  EXPECT_EQ(Convergence::stagnated, judge(2.1));
  EXPECT_EQ(Convergence::contracting, monitor.go_on());
  EXPECT_EQ(Convergence::stagnated, judge(4.5));
  EXPECT_EQ(Convergence::diverged, monitor.go_on());
}

TEST_F(Monitor, BlamesOldFactorsForGrowthFirst) {
  begin();
  judge(1.0);
  EXPECT_EQ(Convergence::stale_jacobian, judge(3.0));
}

TEST_F(Monitor, EndsAtTheRoundingFloor) {
  begin_fresh(noisy_q, noisy_v);
  EXPECT_EQ(Convergence::contracting, judge(1.0e-8));
  EXPECT_EQ(Convergence::at_rounding, judge(0.9e-8));
  EXPECT_EQ(0.9e-8, record.noise);
}

TEST_F(Monitor, ConvergesWhereATenthOfARoundingIsLeft) {
  begin(1e-6, 10.0);
  EXPECT_EQ(Convergence::converged, judge(0.09 * eps / 1e-6));
  begin(1e-6, 10.0);
  EXPECT_EQ(Convergence::contracting, judge(0.11 * eps / 1e-6));
}

TEST_F(Monitor, EndsWhereALaterUpdateIsLessThanARounding) {
  begin_fresh(1e-6, 10.0);
  judge(4.0 * eps / 1e-6);
  EXPECT_EQ(Convergence::at_rounding, judge(0.9 * eps / 1e-6));
  begin_fresh(1e-6, 10.0);
  judge(4.0 * eps / 1e-6);
  EXPECT_EQ(Convergence::contracting, judge(1.1 * eps / 1e-6));
}

TEST_F(Monitor, GoesOnAboveTheRoundingFloor) {
  begin_fresh(noisy_q, noisy_v);
  judge(1.5e-8);
  EXPECT_EQ(Convergence::stagnated, judge(1.2e-8));
}

TEST_F(Monitor, KnowsNoiseAtTheFirstUpdateForSixtyFourStages) {
  record.noise = 0.5e-8;
  for (int stage = 0; stage < 64; ++stage) {
    begin(noisy_q, noisy_v);
    EXPECT_EQ(Convergence::at_rounding, judge(1e-8)) << stage;
  }
  begin(noisy_q, noisy_v);
  EXPECT_EQ(Convergence::contracting, judge(1e-8));
}

TEST_F(Monitor, TakesMoreThanTwiceTheNoiseForNone) {
  record.noise = 0.4e-8;
  begin(noisy_q, noisy_v);
  EXPECT_EQ(Convergence::contracting, judge(1e-8));
}

TEST_F(Monitor, RenewsFactorsThatNoiseMayComeOf) {
  for (int stage = 0; stage < 4; ++stage) {
    EXPECT_TRUE(record.usable) << stage;
    begin(noisy_q, noisy_v);
    judge(1.0e-8);
    EXPECT_EQ(Convergence::at_rounding, judge(0.9e-8)) << stage;
    EXPECT_EQ(0.0, record.noise);  // of old factors it is no measure
  }
  EXPECT_FALSE(record.usable);
  EXPECT_EQ(0, record.noisy_updates);  // of the new ones
}

TEST_F(Monitor, WaitsForInternalVariables) {
  begin();
  EXPECT_EQ(Convergence::contracting, judge(1e-9, false));
  EXPECT_EQ(Convergence::converged, judge(1e-12, true));
}

TEST_F(Monitor, FindsNumbersThatAreNotFinite) {
  for (const double size : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    begin();
    EXPECT_EQ(Convergence::not_finite, judge(size));
  }
}

TEST_F(Monitor, ConvergesAtAnUpdateOfZero) {
  acting = 1;
  begin();
  EXPECT_EQ(Convergence::converged, judge(0.0));
}

TEST_F(Monitor, AllowsVelocitiesAPartOfTheErrorOfThePredictor) {
  const double b = 1e-6;  // 5000 such steps together: 1 / (5000 b) = 200 tolerances at most
  begin(b * b, b);
  judge(1e2);
  EXPECT_DOUBLE_EQ(1e-4 * 1e2 * b, monitor.velocity_tolerance());
  EXPECT_DOUBLE_EQ(1e4, monitor.predictor_error());
  begin(b * b, b);
  judge(1e4);
  EXPECT_DOUBLE_EQ(200.0 * tau, monitor.velocity_tolerance());
  begin(b * b, b);
  judge(1e-3);
  EXPECT_EQ(tau, monitor.velocity_tolerance());
}

TEST_F(Monitor, CallsATenthOfTheToleranceNegligible) {
  begin();
  judge(1e-8);
  EXPECT_FALSE(monitor.is_negligible());  // the first update of a stage never is
  judge(0.9e-8);
  EXPECT_TRUE(monitor.is_negligible());  // in 1 ms 0.9e-11 of velocity
  judge(1.1e-8);
  EXPECT_FALSE(monitor.is_negligible());
}

}  // namespace
}  // namespace freeplay
