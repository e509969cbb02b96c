#include "run/event_finder.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// The cubic a + b s + c s^2 + d s^3 by its ends.
Hermite cubic(double a, double b, double c, double d) { return {a, b, a + b + c + d, b + 2.0 * c + 3.0 * d}; }

TEST(HermiteCubic, ContinuesPastItsInterval) {
  const Hermite ahead = cubic(-0.1, 0.2, 0.3, 0.4).ahead(0.7);
  for (const double s : {0.0, 0.25, 1.0}) {
    const double x = 1.0 + 0.7 * s;
    EXPECT_NEAR(ahead.at(s), -0.1 + x * (0.2 + x * (0.3 + x * 0.4)), 4e-15) << s;
  }
}

TEST(FirstRise, FindsTheZeroOfALineToRounding) {
  const auto s = first_rise(cubic(-0.3, 1.0, 0.0, 0.0), 0.0);
  ASSERT_TRUE(s);
  EXPECT_NEAR(*s, 0.3, 1e-15);
}

TEST(FirstRise, FindsTheZeroOfACubic) {
  const auto s = first_rise(cubic(-0.1, 0.2, 0.3, 0.4), 0.0);
  ASSERT_TRUE(s);
  const double x = *s;
  EXPECT_NEAR(-0.1 + x * (0.2 + x * (0.3 + x * 0.4)), 0.0, 1e-15);
}

TEST(FirstRise, NothingWhenTheCurveStaysBelow) {
  EXPECT_FALSE(first_rise(cubic(-1.0, 0.5, 0.0, 0.0), 0.0));
  EXPECT_FALSE(first_rise(cubic(-0.26, 1.0, -1.0, 0.0), 0.0));  // its top is at -0.01
}

TEST(FirstRise, NothingWhenTheCurveFalls) { EXPECT_FALSE(first_rise(cubic(0.3, -1.0, 0.0, 0.0), 0.0)); }

TEST(FirstRise, EndingExactlyAtZeroIsNotYetPast) { EXPECT_FALSE(first_rise(cubic(-1.0, 1.0, 0.0, 0.0), 0.0)); }

// (s - 0.2)(0.6 - s): both ends lie below zero.
TEST(FirstRise, SeesAContactThatOpensAndClosesInsideTheStep) {
  const auto s = first_rise(cubic(-0.12, 0.8, -1.0, 0.0), 0.0);
  ASSERT_TRUE(s);
  EXPECT_NEAR(*s, 0.2, 1e-15);
}

// (s - 0.1)(s - 0.5)(s - 0.8) rises at 0.1 and 0.8.
TEST(FirstRise, TakesTheFirstOfSeveralAndTheNextFromThere) {
  const Hermite curve = cubic(-0.04, 0.53, -1.4, 1.0);
  const auto first = first_rise(curve, 0.0);
  ASSERT_TRUE(first);
  EXPECT_NEAR(*first, 0.1, 1e-14);
  const auto second = first_rise(curve, 0.5);
  ASSERT_TRUE(second);
  EXPECT_NEAR(*second, 0.8, 1e-14);
}

TEST(FirstRise, WhatIsPastZeroAlreadyDoesNotCross) { EXPECT_FALSE(first_rise(cubic(0.5, 1.0, 0.0, 0.0), 0.25)); }

TEST(FirstRise, StartingAtZeroAndRisingIsARise) {
  const auto s = first_rise(cubic(0.0, 1.0, 0.0, 0.0), 0.0);
  ASSERT_TRUE(s);
  EXPECT_NEAR(*s, 0.0, 1e-15);
}

// The curve at the found place is past zero: whoever looks there sees what was found.
TEST(FirstRise, LiesOnTheFarSideOfTheZero) {
  const Hermite curve = cubic(-1e-9, 3e-7, 2e-8, -1e-8);
  const auto s = first_rise(curve, 0.0);
  ASSERT_TRUE(s);
  EXPECT_GT(curve.at(*s), 0.0);
  EXPECT_LE(curve.at(*s * (1.0 - 1e-12)), 0.0);
}

TEST(Hermite, RunsThroughItsEnds) {
  const Hermite curve = cubic(2.0, -1.0, 0.5, 0.25);
  EXPECT_DOUBLE_EQ(curve.at(0.0), 2.0);
  EXPECT_DOUBLE_EQ(curve.at(1.0), 1.75);
  EXPECT_DOUBLE_EQ(curve.at(0.5), 2.0 - 0.5 + 0.125 + 0.03125);
}

}  // namespace
}  // namespace freeplay
