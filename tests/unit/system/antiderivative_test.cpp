#include "system/antiderivative.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

Expression compiled(const char* text) { return Expression::compile(text, EmptyScope(), true); }

/// Largest error over many instants, those between panels included.
double worst_error(const char* text, double start, double end, const std::function<double(double)>& exact) {
  const Expression f = compiled(text);
  const Antiderivative integral(f, start, end, {});
  double worst = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double t = start + (end - start) * i / 1000.0;
    double value = 0.0;
    EvaluationFailure failure;
    EXPECT_TRUE(integral.evaluate(t, value, failure));
    worst = std::max(worst, std::abs(value - (exact(t) - exact(start))));
  }
  return worst;
}

// 1e-12 of the largest value is what the model format promises for drivers of speed.
TEST(Antiderivative, IntegratesSmoothFunctions) {
  EXPECT_LE(worst_error("3*cos(7*t) + 2*t", 0.5, 3.0, [](double t) { return 3.0 / 7.0 * std::sin(7.0 * t) + t * t; }),
            1e-12);
  EXPECT_LE(worst_error("exp(-2*t)", -1.0, 4.0, [](double t) { return -0.5 * std::exp(-2.0 * t); }), 4e-12);
}

TEST(Antiderivative, FollowsThousandsOfOscillations) {
  EXPECT_LE(worst_error("1 + sin(5000*t)", 0.0, 2.0, [](double t) { return t - std::cos(5000.0 * t) / 5000.0; }),
            2e-12);
}

TEST(Antiderivative, FindsKinksAndRamps) {
  EXPECT_LE(worst_error("abs(t - 0.3)", 0.0, 1.0, [](double t) { return 0.5 * (t - 0.3) * std::abs(t - 0.3); }), 1e-12);
  const auto ramp = [](double t) {
    const double s = std::clamp((t - 0.2) / 0.3, 0.0, 1.0);
    return 0.3 * std::pow(s, 4) * (s * s - 3.0 * s + 2.5) + std::max(0.0, t - 0.5);
  };
  EXPECT_LE(worst_error("smooth(t, 0.2, 0.5)", 0.0, 1.0, ramp), 1e-12);
}

TEST(Antiderivative, AConstantIsExact) {
  EXPECT_EQ(worst_error("2", 1.0, 3.0, [](double t) { return 2.0 * t; }), 0.0);
}

TEST(Antiderivative, DoesNotDependOnEarlierCalls) {
  const Expression f = compiled("cos(40*t)*exp(t)");
  const Antiderivative integral(f, 0.0, 2.0, {});
  EvaluationFailure failure;
  double alone = 0.0, other = 0.0, again = 0.0;
  ASSERT_TRUE(integral.evaluate(1.234, alone, failure));
  ASSERT_TRUE(integral.evaluate(0.1, other, failure));
  ASSERT_TRUE(integral.evaluate(1.9, other, failure));
  ASSERT_TRUE(integral.evaluate(1.234, again, failure));
  EXPECT_EQ(alone, again);
}

TEST(Antiderivative, RefusesAFunctionWithoutValues) {
  const Expression f = compiled("sqrt(0.5 - t)");
  try {
    const Antiderivative integral(f, 0.0, 1.0, {"model.yaml", 3, 4});
    FAIL() << "integrated a square root of negative numbers";
  } catch (const Error& error) {
    EXPECT_EQ(error.category(), Error::Category::input);
    EXPECT_EQ(error.id(), "bad-expression");
    EXPECT_EQ(error.location().line, 3);
  }
}

}  // namespace
}  // namespace freeplay
