#include "results/divergence.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

namespace freeplay {
namespace {

RowGrid grid_of(std::size_t rows, double interval) {
  RowGrid grid{.interval = interval, .rows = {}};
  for (std::size_t i = 0; i < rows; ++i) grid.rows.push_back(i);
  return grid;
}

Divergence of(const std::vector<double>& x, const std::vector<double>& y, double interval, double period) {
  const std::span<const double> columns[] = {x, y};
  return divergence(grid_of(x.size(), interval), columns, period);
}

// x' = 1 - 1.4 x^2 + y, y' = 0.3 x: the exponent is 0.419 (Wolf and others 1985, table 1).
TEST(Divergence, OfTheHenonMapIsItsExponent) {
  std::vector<double> x, y;
  double a = 0.1, b = 0.3;
  for (int i = 0; i < 3100; ++i) {
    const double next = 1.0 - 1.4 * a * a + b;
    b = 0.3 * a, a = next;
    if (i >= 100) x.push_back(a), y.push_back(b);
  }
  const Divergence d = of(x, y, 1.0, 7.0);
  EXPECT_EQ(d.time.size(), 8u);
  EXPECT_NEAR(d.exponent, 0.419, 0.04);
  EXPECT_GT(d.uncertainty, 0.0);
  EXPECT_LT(d.uncertainty, 0.02);
  EXPECT_EQ(d.points, 2993u);
  EXPECT_NEAR(of(x, y, 0.5, 3.5).exponent, 2.0 * d.exponent, 1e-12);  // by time, not by step
}

// x' = 4 x (1 - x): the exponent is ln 2. Over long periods distances reach the size of the motion and grow no more.
TEST(Divergence, OfTheLogisticMapIsWithinItsUncertaintyForEveryPeriod) {
  std::vector<double> x;
  double a = 0.3;
  for (int i = 0; i < 1500; ++i) x.push_back(a = 4.0 * a * (1.0 - a));
  const std::span<const double> columns[] = {x};
  for (const double period : {2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 18.0, 20.0, 40.0, 80.0, 200.0}) {
    const Divergence d = divergence(grid_of(x.size(), 1.0), columns, period);
    EXPECT_LT(std::abs(d.exponent - std::log(2.0)), 2.0 * d.uncertainty) << period;
  }
  EXPECT_LT(divergence(grid_of(x.size(), 1.0), columns, 7.0).uncertainty, 0.02);
  EXPECT_TRUE(std::isnan(divergence(grid_of(x.size(), 1.0), columns, 1.0).uncertainty));
}

TEST(Divergence, OfAPeriodicMotionIsNone) {
  std::vector<double> x, y;
  for (int i = 0; i < 1000; ++i) x.push_back(std::cos(0.1 * i)), y.push_back(std::sin(0.1 * i));
  EXPECT_NEAR(of(x, y, 1.0, 63.0).exponent, 0.0, 1e-6);
}

// Neighbours on a spiral x = e^(a t) (cos t, sin t), the period 2 pi apart, go apart as e^(a t).
TEST(Divergence, OfAGrowingSpiralIsItsGrowth) {
  std::vector<double> x, y;
  const double growth = 0.02, step = 2.0 * M_PI / 60.0;
  for (int i = 0; i < 1200; ++i) {
    const double t = step * i, r = std::exp(growth * t);
    x.push_back(r * std::cos(t)), y.push_back(r * std::sin(t));
  }
  EXPECT_NEAR(of(x, y, step, 59.5 * step).exponent, growth, 1e-3 * growth);
}

TEST(Divergence, LeavesOutColumnsThatDoNotChange) {
  std::vector<double> x, y(200, 3.0);
  double a = 0.3;
  for (int i = 0; i < 200; ++i) x.push_back(a), a = 3.9 * a * (1.0 - a);
  const std::span<const double> alone[] = {x};
  EXPECT_EQ(of(x, y, 1.0, 3.0).exponent, divergence(grid_of(200, 1.0), alone, 3.0).exponent);
}

TEST(Divergence, ThinsRowsBeyondFiveThousand) {
  std::vector<double> x, y;
  for (int i = 0; i < 5003; ++i) x.push_back(std::cos(0.37 * i)), y.push_back(std::sin(0.37 * i));
  const Divergence d = of(x, y, 1.0, 20.0);
  EXPECT_EQ(d.time[1], 2.0);
  EXPECT_EQ(d.points, 2502u - 10u);
}

TEST(Divergence, RefusesWhatNoLineCanBeDrawnThrough) {
  const std::vector<double> x{1, 2, 3, 4, 5, 6, 7, 8}, still(8, 1.0);
  EXPECT_THROW(of(x, x, 1.0, 0.4), Error);  // shorter than a step
  EXPECT_THROW(of(x, x, 1.0, 4.0), Error);  // two periods do not fit
  EXPECT_THROW(of(still, still, 1.0, 2.0), Error);
  EXPECT_THROW(of({}, {}, 1.0, 2.0), Error);
}

}  // namespace
}  // namespace freeplay
