#include "model/time_table.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

Jet at(const TimeTable& table, double t) {
  Jet jet;
  EvaluationFailure failure;
  EXPECT_TRUE(table.evaluate(t, jet, failure)) << failure.reason;
  return jet;
}
double integral(const TimeTable& table, double t) {
  double value = 0.0;
  EvaluationFailure failure;
  EXPECT_TRUE(table.integral(t, value, failure)) << failure.reason;
  return value;
}

TEST(TimeTable, GoesStraightBetweenPoints) {
  const TimeTable table({0.0, 1.0, 3.0}, {2.0, 4.0, 0.0}, Interpolation::linear, SplineEnds::natural, Outside::hold);
  EXPECT_DOUBLE_EQ(at(table, 0.5).value, 3.0);
  EXPECT_DOUBLE_EQ(at(table, 0.5).rate, 2.0);
  EXPECT_EQ(at(table, 0.5).acceleration, 0.0);
  EXPECT_DOUBLE_EQ(at(table, 1.0).rate, -2.0);  // at a point the right side counts
  EXPECT_DOUBLE_EQ(integral(table, 2.0), 3.0 + 3.0);
}

TEST(TimeTable, NaturalSplineOfThreePoints) {
  // By hand: M = (0, -3, 0) for (0,0), (1,1), (2,0); then y(1/2) = 1/2 + (1/8 - 1/2)(-3)/6 = 11/16.
  const TimeTable table({0.0, 1.0, 2.0}, {0.0, 1.0, 0.0}, Interpolation::cubic, SplineEnds::natural, Outside::hold);
  EXPECT_NEAR(at(table, 0.5).value, 11.0 / 16.0, 1e-15);
  EXPECT_NEAR(at(table, 0.0).rate, 1.5, 1e-15);
  EXPECT_NEAR(at(table, 1.0).acceleration, -3.0, 1e-15);
  EXPECT_NEAR(integral(table, 2.0), 1.25, 1e-15);
}

TEST(TimeTable, ClampedSplineIsAtRestAtItsEnds) {
  // One piece between rest and rest is 3 b^2 - 2 b^3.
  const TimeTable table({1.0, 3.0}, {0.0, 1.0}, Interpolation::cubic, SplineEnds::clamped, Outside::hold);
  EXPECT_NEAR(at(table, 1.0).rate, 0.0, 1e-15);
  EXPECT_NEAR(at(table, 3.0).rate, 0.0, 1e-15);
  EXPECT_NEAR(at(table, 1.5).value, 3.0 / 16.0 - 2.0 / 64.0, 1e-15);
}

TimeTable sampled_sine(int pieces, SplineEnds ends, Outside outside) {
  std::vector<double> t, x;
  for (int i = 0; i <= pieces; ++i) {
    t.push_back(i / static_cast<double>(pieces) * (1.0 + 0.01 * std::sin(M_PI * i / pieces)));
    x.push_back(i == pieces ? 0.0 : std::sin(2.0 * M_PI * t.back()));
  }
  return {t, x, Interpolation::cubic, ends, outside};
}

TEST(TimeTable, PeriodicSplineGoesOnSmoothly) {
  const TimeTable table = sampled_sine(64, SplineEnds::periodic, Outside::repeat);
  const Jet before = at(table, 1.0 - 1e-9), after = at(table, 1.0 + 1e-9);
  EXPECT_NEAR(before.rate, after.rate, 1e-6);
  EXPECT_NEAR(before.acceleration, after.acceleration, 1e-5);
  EXPECT_NEAR(at(table, 5.3).value, std::sin(2.0 * M_PI * 0.3), 1e-5);
  EXPECT_NEAR(at(table, -0.2).value, std::sin(2.0 * M_PI * 0.8), 1e-5);
  EXPECT_NEAR(integral(table, 2.25), 1.0 / (2.0 * M_PI), 1e-6);
}

TEST(TimeTable, PeriodicSplineOfThreePoints) {
  const TimeTable table({0.0, 1.0, 2.0}, {0.0, 1.0, 0.0}, Interpolation::cubic, SplineEnds::periodic, Outside::repeat);
  // Symmetric about both points, so at rest there: each half is 3 b^2 - 2 b^3.
  EXPECT_NEAR(at(table, 0.0).rate, 0.0, 1e-15);
  EXPECT_NEAR(at(table, 0.25).value, 3.0 / 16.0 - 2.0 / 64.0, 1e-15);
}

TEST(TimeTable, DerivativesAndIntegralAreExact) {
  for (const SplineEnds ends : {SplineEnds::natural, SplineEnds::clamped, SplineEnds::periodic}) {
    const TimeTable table = sampled_sine(9, ends, Outside::hold);
    const double h = 1e-5;
    for (const double t : {0.03, 0.41, 0.77, 0.96}) {
      EXPECT_NEAR(at(table, t).rate, (at(table, t + h).value - at(table, t - h).value) / (2.0 * h), 1e-7);
      EXPECT_NEAR(at(table, t).acceleration, (at(table, t + h).rate - at(table, t - h).rate) / (2.0 * h), 1e-6);
      EXPECT_NEAR(at(table, t).value, (integral(table, t + h) - integral(table, t - h)) / (2.0 * h), 1e-8);
    }
  }
}

TEST(TimeTable, HoldsItsEndValuesAtRest) {
  const TimeTable table({1.0, 2.0}, {3.0, 5.0}, Interpolation::linear, SplineEnds::natural, Outside::hold);
  EXPECT_EQ(at(table, 0.0).value, 3.0);
  EXPECT_EQ(at(table, 0.0).rate, 0.0);
  EXPECT_EQ(at(table, 9.0).value, 5.0);
  EXPECT_EQ(at(table, 9.0).rate, 0.0);
  EXPECT_EQ(at(table, 2.0).rate, 2.0);
  EXPECT_EQ(at(table, 2.0 + 4e-16).rate, 2.0);  // a rounding error behind the end is still the end
  EXPECT_DOUBLE_EQ(integral(table, 4.0), 4.0 + 10.0);
  EXPECT_DOUBLE_EQ(integral(table, 0.0), -3.0);
}

TEST(TimeTable, RefusesTimesOutsideWhenAskedTo) {
  const TimeTable table({1.0, 2.0}, {3.0, 5.0}, Interpolation::linear, SplineEnds::natural, Outside::error);
  Jet jet;
  EvaluationFailure failure;
  EXPECT_FALSE(table.evaluate(2.1, jet, failure));
  EXPECT_STREQ(failure.id, "bad-table");
  EXPECT_TRUE(table.evaluate(2.0, jet, failure));
}

TEST(TimeTable, KinksAreThePointsOfAStraightTableAndTheEndsOfOthers) {
  const std::vector<double> times{0.5, 1.0, 3.0}, values{2.0, 4.0, 2.0};
  const TimeTable straight(times, values, Interpolation::linear, SplineEnds::natural, Outside::hold);
  EXPECT_EQ(straight.next_kink(0.0), 0.5);
  EXPECT_EQ(straight.next_kink(0.5), 1.0);
  EXPECT_NEAR(straight.next_kink(1.0), 3.0, 1e-11);
  EXPECT_TRUE(std::isinf(straight.next_kink(3.001)));
  const TimeTable spline(times, values, Interpolation::cubic, SplineEnds::natural, Outside::hold);
  EXPECT_NEAR(spline.next_kink(0.5), 3.0, 1e-11);
  // A run that ends with its table does not see what comes behind it.
  EXPECT_GT(spline.next_kink(0.5), 3.0);
}

TEST(TimeTable, KinksOfARepeatedTableComeAgainAndAgain) {
  const TimeTable table({0.0, 0.1, 0.2}, {0.0, 1.0, 0.0}, Interpolation::linear, SplineEnds::natural, Outside::repeat);
  double t = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    const double next = table.next_kink(t);
    ASSERT_NEAR(next, 0.1 * i, 1e-11) << i;
    t = next * (1.0 + 1e-15);  // behind its rounding
  }
}

// The points of a period are where rounding of t less the periods before may pass them by.
TEST(TimeTable, NoPointOfARepeatedTableIsPassedByInAnyPeriod) {
  for (const std::vector<double>& times : {std::vector<double>{0.0, 0.115, 0.125, 0.135, 0.25},
                                           {0.0, 0.01, 0.0101, 0.0102, 0.02},
                                           {0.3, 0.7, 1.1, 1.3, 1.9}}) {
    const TimeTable table(times, {0.0, 0.0, 1.0, 0.0, 0.0}, Interpolation::linear, SplineEnds::natural,
                          Outside::repeat);
    const double period = times.back() - times.front();
    double t = times.front() - 1000.0 * period;
    for (int k = -1000; k < 1000; ++k) {
      for (std::size_t i = 1; i < times.size(); ++i) {
        const double next = table.next_kink(t);
        ASSERT_NEAR(next, times[i] + k * period, 1e-11) << "point " << i << " of period " << k;
        t = next;
      }
    }
  }
}

}  // namespace
}  // namespace freeplay
