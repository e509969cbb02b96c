#include "base/jet.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// Compares rate and acceleration with central differences of the value. With h = 1e-4 the truncation error is of order
/// h^2 = 1e-8 and the round-off of the second difference 1e-16/h^2 = 1e-8; both stay below 1e-6 for derivatives of
/// order 10.
void expect_exact_derivatives(const std::function<Jet(Jet)>& f, double t) {
  const double h = 1e-4;
  const auto value = [&](double at) { return f(Jet::time(at)).value; };
  const Jet jet = f(Jet::time(t));
  EXPECT_NEAR(jet.rate, (value(t + h) - value(t - h)) / (2.0 * h), 1e-6 * (1.0 + std::abs(jet.rate)));
  EXPECT_NEAR(jet.acceleration, (value(t + h) - 2.0 * value(t) + value(t - h)) / (h * h),
              1e-5 * (1.0 + std::abs(jet.acceleration)));
}

void expect_jet(const Jet& jet, double value, double rate, double acceleration) {
  EXPECT_NEAR(jet.value, value, 1e-14 * (1.0 + std::abs(value)));
  EXPECT_NEAR(jet.rate, rate, 1e-14 * (1.0 + std::abs(rate)));
  EXPECT_NEAR(jet.acceleration, acceleration, 1e-14 * (1.0 + std::abs(acceleration)));
}

TEST(Jet, AppliesProductAndQuotientRules) {
  const Jet t = Jet::time(2.0);
  expect_jet(t * t * t, 8.0, 12.0, 12.0);                // t^3
  expect_jet(Jet::constant(1.0) / t, 0.5, -0.25, 0.25);  // 1/t: -1/t^2, 2/t^3
  expect_jet((t * t - t) / (t + t), 0.5, 0.5, 0.0);      // (t - 1)/2
}

TEST(Jet, DerivesEveryFunctionExactly) {
  const auto x = [](Jet t) { return Jet::constant(0.3) + Jet::constant(0.4) * t * t; };  // 0.498 at 0.7
  for (const auto& f : std::initializer_list<std::function<Jet(Jet)>>{
           [&](Jet t) { return sin(x(t)); }, [&](Jet t) { return cos(x(t)); }, [&](Jet t) { return tan(x(t)); },
           [&](Jet t) { return asin(x(t)); }, [&](Jet t) { return acos(x(t)); }, [&](Jet t) { return sqrt(x(t)); },
           [&](Jet t) { return exp(x(t)); }, [&](Jet t) { return log(x(t)); }, [&](Jet t) { return abs(-x(t)); },
           [&](Jet t) { return atan2(x(t), -t); }, [&](Jet t) { return pow(x(t), 2.5); },
           [&](Jet t) { return pow(-x(t), 3.0); }, [&](Jet t) { return pow(x(t), t * t); },
           [&](Jet t) { return min(x(t), t); }, [&](Jet t) { return max(x(t), t); },
           [&](Jet t) { return smooth(t, x(t) - Jet::constant(0.3), Jet::constant(1.0)); }}) {
    expect_exact_derivatives(f, 0.7);
  }
}

TEST(Jet, TakesTheDerivativeFromTheRightAtAKink) {
  const Jet t = Jet::time(0.0), zero = Jet::constant(0.0);
  expect_jet(abs(t), 0.0, 1.0, 0.0);
  expect_jet(abs(-t), 0.0, 1.0, 0.0);
  expect_jet(max(zero, t), 0.0, 1.0, 0.0);
  expect_jet(max(t, zero), 0.0, 1.0, 0.0);
  expect_jet(min(zero, t), 0.0, 0.0, 0.0);
  expect_jet(max(t, t + t * t), 0.0, 1.0, 2.0);  // equal value and rate; the second derivative decides
}

TEST(Jet, LeavesAConstantArgumentConstantWhereTheSlopeIsInfinite) {
  expect_jet(sqrt(Jet::constant(0.0)), 0.0, 0.0, 0.0);
  expect_jet(acos(Jet::constant(1.0)), 0.0, 0.0, 0.0);
}

TEST(Jet, RaisesZeroToSmallIntegerPowers) {
  const Jet t = Jet::time(0.0);
  expect_jet(pow(t, 0.0), 1.0, 0.0, 0.0);
  expect_jet(pow(t, 1.0), 0.0, 1.0, 0.0);
  expect_jet(pow(t, 2.0), 0.0, 0.0, 2.0);
}

TEST(Jet, SmoothStepHasThePolynomialsDerivatives) {
  // s = t/2, f = 6s^5 - 15s^4 + 10s^3; at s = 1/2: f = 1/2, df/ds = 15/8, d2f/ds2 = 0.
  const Jet zero = Jet::constant(0.0), two = Jet::constant(2.0);
  expect_jet(smooth(Jet::time(1.0), zero, two), 0.5, 15.0 / 16.0, 0.0);
  // at s = 1/4: f = 6/1024 - 15/256 + 10/64 = 106/1024, df/ds = 30 s^2 (1-s)^2 = 270/256, d2f/ds2 = 60 s(1-s)(1-2s)
  // = 5.625.
  expect_jet(smooth(Jet::time(0.5), zero, two), 106.0 / 1024.0, 135.0 / 256.0, 5.625 / 4.0);
  expect_jet(smooth(Jet::time(-1.0), zero, two), 0.0, 0.0, 0.0);
  expect_jet(smooth(Jet::time(3.0), zero, two), 1.0, 0.0, 0.0);
}

}  // namespace
}  // namespace freeplay
