#include "run/step_control.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(StepControl, SteadyErrorOfOneShrinksTheStepByTheSafetyFactor) {
  StepControl control({1.0, 1e-6, 10.0}, 5);
  control.accept(1.0, 1.0);
  EXPECT_NEAR(control.next(), 0.9, 1e-15);
}

TEST(StepControl, GrowsByFiveAtMostAndNotBeyondTheLargest) {
  StepControl control({1.0, 1e-6, 30.0}, 5);
  control.accept(1.0, 0.5);
  control.accept(1.0, 0.0);
  EXPECT_EQ(control.next(), 5.0);
  control.accept(20.0, 0.0);
  EXPECT_EQ(control.next(), 30.0);
}

TEST(StepControl, AStepBetweenCornersThatRoundingKeepsApartDoesNotHoldBackTheNext) {
  StepControl control({1.0, 1e-6, 10.0}, 5);
  control.accept(1.0, 1e-3);
  const double proposed = control.next();
  control.accept(1e-12, 0.0);
  EXPECT_EQ(control.next(), proposed);
  control.accept(2e-6, 0.0);
  EXPECT_LT(control.next(), 1e-3);
}

void expect_far_growth_while_errors_are_tiny(StepControl& control, double dt) {
  for (int step = 0; step < 2; ++step) {
    control.accept(dt, 1e-12);
    EXPECT_GT(control.next(), 30.0 * dt);
    dt = control.next();
  }
  control.accept(dt, 1e-6);
  dt = control.next();
  control.accept(dt, 1e-12);
  EXPECT_NEAR(control.next() / dt, 5.0, 1e-12);
}

TEST(StepControl, FirstStepsMayGrowFar) {
  StepControl control({1e-7, 1e-9, 1.0}, 5);
  expect_far_growth_while_errors_are_tiny(control, 1e-7);
}

TEST(StepControl, ARejectedFirstStepGrowsNoMore) {
  StepControl control({1.0, 1e-6, 1e3}, 5);
  control.reject(1.0, 2.0);
  const double cut = control.next();
  control.accept(cut, 0.0);
  control.accept(cut, 0.0);
  EXPECT_LE(control.next(), 5.0 * cut);
}

TEST(StepControl, RejectedStepIsMadeShorterAndTheNextDoesNotGrow) {
  StepControl control({1.0, 1e-6, 10.0}, 3);
  control.reject(1.0, 8.0);
  EXPECT_NEAR(control.next(), 0.45, 1e-15);
  control.accept(0.45, 1e-6);
  EXPECT_EQ(control.next(), 0.45);
  control.accept(0.45, 1e-6);
  EXPECT_GT(control.next(), 0.45);
}

TEST(StepControl, AnErrorThatIsNaNTakesTheLargestCut) {
  StepControl control({1.0, 1e-6, 10.0}, 3);
  control.reject(1.0, std::nan(""));
  EXPECT_NEAR(control.next(), 0.1, 1e-15);
}

TEST(StepControl, StepThatEndsAtAnEventLeavesTheProposal) {
  StepControl control({1.0, 1e-6, 10.0}, 3);
  control.accept(1.0, 0.5);
  const double before = control.next();
  control.cut(1);
  EXPECT_EQ(control.next(), before);
}

TEST(StepControl, StepThatHardlyErredSaysLittleOfTheNext) {
  StepControl control({1.0, 1e-6, 10.0, 2.0}, 5);
  control.accept(1.0, 1e-13);
  EXPECT_EQ(control.next(), 2.0);
  control.accept(2.0, 1e-9);
  EXPECT_EQ(control.next(), 10.0);
}

TEST(StepControl, AStepAfterAnEventMayBeFarTooShort) {
  StepControl control({1.0, 1e-6, 1e3}, 5);
  control.accept(1.0, 0.5);
  control.cut(1);
  expect_far_growth_while_errors_are_tiny(control, 1e-5);
}

TEST(StepControl, AForceLawMetBeforeBeginsWithTheStepThatSuitedItThen) {
  constexpr std::uint64_t flight = 0, contact = 1;
  StepControl control({1.0, 1e-6, 1e3}, 5);
  control.accept(1.0, 0.5);
  control.cut(contact);
  control.reject(control.next(), 1e6);
  const double first = control.next();
  control.accept(first, 0.9);
  const double of_contact = control.next();
  control.accept(of_contact, 1e-3);
  const double last = control.next();
  control.cut(flight);  // nothing is known of it
  EXPECT_EQ(control.next(), last);
  control.accept(last, 1e-9);
  const double of_flight = control.next();
  control.accept(of_flight, 2e-2);
  control.cut(contact);
  EXPECT_EQ(control.next(), of_contact);
  control.cut(flight);
  EXPECT_EQ(control.next(), of_flight);
}

TEST(StepControl, LawThatEndedInItsFirstStepLeavesTheProposal) {
  StepControl control({1.0, 1e-6, 1e3}, 5);
  control.accept(1.0, 0.5);
  const double before = control.next();
  for (const std::uint64_t law : {1u, 2u, 1u}) {
    control.cut(law);
    EXPECT_EQ(control.next(), before);
  }
}

TEST(StepControl, OfManyForceLawsTheLatestAreRemembered) {
  StepControl control({1.0, 1e-6, 1e3}, 5);
  std::vector<double> first;
  for (std::uint64_t law = 0; law < 20; ++law) {
    control.cut(law);
    control.accept(control.next(), law % 2 == 0 ? 0.9 : 0.4);
    first.push_back(control.next());
  }
  control.cut(19);
  EXPECT_EQ(control.next(), first[19]);
  control.cut(15);
  EXPECT_EQ(control.next(), first[15]);
  control.cut(3);  // forgotten
  EXPECT_EQ(control.next(), first[15]);
}

TEST(StepControl, ErrorsAfterAnEventFallWithTheCubeOfTheStep) {
  StepControl control({1.0, 1e-6, 10.0}, 6);
  control.cut(1);
  control.reject(1.0, 27.0);
  EXPECT_NEAR(control.next(), 0.3, 1e-15);
  control.accept(0.3, 0.5);
  control.reject(1.0, 64.0);
  EXPECT_NEAR(control.next(), 0.45, 1e-15);
}

TEST(StepControl, ShortensTheStepByTheRootOfASmallerTolerance) {
  StepControl control({1.0, 1e-6, 10.0}, 5);
  control.accept(1.0, 1.0);
  control.allow(1.0 / 32.0);
  EXPECT_NEAR(control.next(), 0.45, 1e-12);
  control.allow(32.0);
  EXPECT_NEAR(control.next(), 0.9, 1e-12);
}

}  // namespace
}  // namespace freeplay
