#include "run/peak_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// Steps through f(t) as a run does; the largest value found, and how many looks that took.
struct Walk {
  double largest = 0.0;
  long looks = 0;
};
template <class F, class Step>
Walk walk_by(const F& f, const Step& step_at, double end, bool all_is_prescribed = false) {
  PeakSearch search(1, all_is_prescribed);
  Walk walk;
  std::vector<double> value(1), largest(1, -1.0);
  const auto see = [&](double t) {
    value[0] = f(t);
    largest[0] = std::max(largest[0], value[0]);
  };
  see(0.0);
  search.restart(0.0, value);
  double step = step_at(0.0);
  for (double t = step; t < end; t += step) {
    see(t);
    search.end_step(t, value);
    for (double s = search.next(largest); s > 0.0; s = search.next(largest)) {
      see(t - step + s * step);
      search.seen(s, value);
      ++walk.looks;
    }
    step = step_at(t);
  }
  walk.largest = largest[0];
  return walk;
}
template <class F>
Walk walk(const F& f, double step, double end) {
  return walk_by(
      f, [step](double) { return step; }, end);
}

// One bump at 0.77 whose width is but a few steps.
TEST(PeakSearch, FindsAMaximumBetweenTheEndsOfSteps) {
  const auto bump = [](double t) { return 5.0 * std::exp(-std::pow((t - 0.77) / 0.1, 2)); };
  for (const double step : {0.011, 0.033, 0.057, 0.081}) {
    SCOPED_TRACE(step);
    EXPECT_NEAR(walk(bump, step, 1.5).largest, 5.0, 2e-4);
  }
}

// A force beside a singular position of links, and steps that shorten towards it: they rise from so far below that
// their ends alone do not show whether the last one went over the top.
TEST(PeakSearch, FindsASharpMaximumThatStepsRiseToFromFarBelow) {
  const auto sharp = [](double t) { return 1e-3 + std::pow(1.0 + std::pow((t - 0.5) / 0.01, 2), -1.5); };
  const double exact = sharp(0.5);
  for (double part = 0.3; part < 0.8; part += 0.01) {
    SCOPED_TRACE(part);
    const auto step = [part](double t) { return part * std::hypot(0.01, t - 0.5); };
    EXPECT_NEAR(walk_by(sharp, step, 1.0).largest, exact, 3e-3 * exact);
  }
}

TEST(PeakSearch, FindsTheLargestOfManyPeaks) {
  const auto beat = [](double t) { return std::abs(std::sin(7.0 * t) * (1.0 + 0.2 * std::sin(1.3 * t))); };
  double exact = 0.0;
  for (double t = 0.0; t < 20.0; t += 1e-5) exact = std::max(exact, beat(t));
  EXPECT_NEAR(walk(beat, 0.043, 20.0).largest, exact, 1e-4 * exact);
}

// Bumps each a little higher than the one before, in steps of half their width.
TEST(PeakSearch, FindsTheLastOfManySmallGainsWhereAllMotionIsPrescribed) {
  const auto bumps = [](double t) {
    const double middle = std::floor(t) + 0.5;
    return (1.0 + 0.004 * middle) * std::exp(-std::pow((t - middle) / 0.2, 2));
  };
  for (const double step : {0.0932, 0.1071, 0.1234}) {
    SCOPED_TRACE(step);
    const auto steps = [step](double) { return step; };
    EXPECT_NEAR(walk_by(bumps, steps, 60.0, true).largest, 1.0 + 0.004 * 59.5, 1e-3);
  }
}

TEST(PeakSearch, LooksAtFewSteps) {
  const auto constant = [](double t) { return 3.0 * (1.0 + 1e-15 * std::sin(1e3 * t)); };
  EXPECT_EQ(walk(constant, 0.01, 100.0).looks, 0);
  const auto rising = [](double t) { return 1.0 + t * t; };
  EXPECT_EQ(walk(rising, 0.01, 100.0).looks, 0);
  const auto periodic = [](double t) { return 1.0 + std::sin(t); };
  EXPECT_LE(walk(periodic, 0.3, 300.0).looks, 1000 / 24 + 9);
}

}  // namespace
}  // namespace freeplay
