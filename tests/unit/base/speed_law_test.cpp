// Laws of speed in formulas against their closed forms.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/expression.h"
#include "base/expression_error.h"

namespace freeplay {
namespace {

class NoParameters : public Scope {
 public:
  const Quantity* find(std::string_view) const override { return nullptr; }
  std::vector<std::string> names() const override { return {}; }
};

Expression speed_formula(std::string_view text) { return Expression::compile(text, NoParameters(), true); }

Jet law_at(const Expression& expression, double t) {
  Jet jet;
  EvaluationFailure failure;
  EXPECT_TRUE(expression.evaluate(t, jet, failure)) << failure.reason;
  return jet;
}

ExpressionError refusal(std::string_view text) {
  try {
    speed_formula(text);
  } catch (const ExpressionError& error) {
    return error;
  }
  return {"accepted", std::string(text), -1, -1};
}

void expect_motion(const Jet& jet, const Jet& wanted, double t) {
  EXPECT_NEAR(jet.value, wanted.value, 1e-12) << t;
  EXPECT_NEAR(jet.rate, wanted.rate, 1e-12) << t;
  EXPECT_NEAR(jet.acceleration, wanted.acceleration, 1e-12) << t;
}

/// The other half of a law is the first one seen from its end.
Jet seen_from_end(const Jet& jet) { return {1.0 - jet.value, jet.rate, -jet.acceleration}; }

// From 0.3 to 2.3 s with ramps of 0.5 s: 0.5 s + 1 s at full speed v make 1.5 v = 1.
Jet first_half_of_trapezoid(double t) {
  const double v = 1.0 / 1.5, a = v / 0.5, u = t - 0.3;
  if (u < 0.0) return {};
  if (u < 0.5) return {0.5 * a * u * u, a * u, a};
  return {0.25 * v + v * (u - 0.5), v, 0.0};
}

TEST(SpeedLaw, GoesByATrapezoidOfSpeed) {
  const Expression formula = speed_formula("trapezoid(t, 0.3 s, 2.3 s, 0.5 s)");
  for (const double t : {0.0, 0.31, 0.5, 0.79, 0.9, 1.3}) {
    expect_motion(law_at(formula, t), first_half_of_trapezoid(t), t);
    expect_motion(law_at(formula, 2.6 - t), seen_from_end(first_half_of_trapezoid(t)), 2.6 - t);
  }
  EXPECT_NEAR(law_at(formula, 1e6).value, 1.0, 1e-15);
}

// From 1 to 5 s with ramps of 1.5 s and rises of 0.4 s: full speed is a (1.5 - 0.4), times 2.5 it is 1.
Jet first_half_of_s_curve(double t) {
  const double a = 1.0 / (1.1 * 2.5), j = a / 0.4, u = t - 1.0;
  if (u < 0.0) return {};
  if (u < 0.4) return {j * u * u * u / 6.0, 0.5 * j * u * u, j * u};
  const double v1 = 0.2 * a, s1 = j * 0.064 / 6.0;
  if (u < 1.1) return {s1 + v1 * (u - 0.4) + 0.5 * a * (u - 0.4) * (u - 0.4), v1 + a * (u - 0.4), a};
  const double v = 1.1 * a, w = 1.5 - u, half = 0.5 * 1.5 * v;  // seen from the end of the ramp
  if (u < 1.5) return {half - v * w + j * w * w * w / 6.0, v - 0.5 * j * w * w, j * w};
  return {half + v * (u - 1.5), v, 0.0};
}

TEST(SpeedLaw, GoesByAnSCurveOfSpeed) {
  const Expression formula = speed_formula("s_curve(t, 1, 5, 1.5, 0.4)");
  for (const double t : {0.0, 1.1, 1.39, 1.5, 2.05, 2.2, 2.49, 2.6, 3.0}) {
    expect_motion(law_at(formula, t), first_half_of_s_curve(t), t);
    expect_motion(law_at(formula, 6.0 - t), seen_from_end(first_half_of_s_curve(t)), 6.0 - t);
  }
}

TEST(SpeedLaw, RoundsTheWholeRampUnlessARiseIsGiven) {
  const Expression given = speed_formula("s_curve(t, 0, 2, 0.6, 0.3)"),
                   left_out = speed_formula("s_curve(t, 0, 2, 0.6)");
  for (const double t : {0.1, 0.4, 1.0, 1.5, 1.8}) expect_motion(law_at(left_out, t), law_at(given, t), t);
}

TEST(SpeedLaw, HasNoPartAtFullSpeedWhereTheRampsMeet) {
  const Expression formula = speed_formula("trapezoid(t, 0.1, 0.3, 0.1)");  // 0.3 - 0.1 is less than twice 0.1
  EXPECT_NEAR(law_at(formula, 0.2).value, 0.5, 1e-14);
  EXPECT_NEAR(law_at(formula, 0.2).rate, 10.0, 1e-12);
  EXPECT_EQ(formula.outline(0.0, 1.0).corners.size(), 3u);
}

// A speed that jumps from -1e-18 to 0 would be a blow.
TEST(SpeedLaw, EndsExactlyAtRest) {
  for (const char* text : {"trapezoid(t, 3, 5, 0.6)", "s_curve(t, 3, 5, 0.6, 0.1)", "s_curve(t, 3, 5, 0.7)"}) {
    const Expression formula = speed_formula(text);
    double t = 5.0;
    for (int i = 0; i < 8; ++i) {
      const double rate = law_at(formula, t).rate;
      EXPECT_TRUE(rate >= 0.0 && rate <= 2.0 * (5.0 - t)) << text << ": " << rate;
      t = std::nextafter(t, 0.0);
    }
  }
}

// At a corner itself and beside it, by the smallest steps of the time, speed and acceleration are those of one side.
TEST(SpeedLaw, HasNoGapBetweenItsParts) {
  const Expression formula = speed_formula("trapezoid(t, 0.1, 0.7, 0.2)");
  const double v = 2.5, a = 12.5;
  for (const double corner : {0.3, 0.5}) {
    double t = corner - 1e-15;
    for (int i = 0; i < 64; ++i) {
      const Jet jet = law_at(formula, t);
      EXPECT_NEAR(jet.rate, v, 1e-12);
      EXPECT_TRUE(std::abs(jet.acceleration) < 1e-12 || std::abs(std::abs(jet.acceleration) - a) < 1e-11);
      t = std::nextafter(t, 1.0);
    }
  }
}

TEST(SpeedLaw, HasItsCornersWhereAccelerationOrJerkJumps) {
  const auto expect_corners = [](std::string_view text, const std::vector<double>& wanted) {
    const std::vector<Corner> corners = speed_formula(text).outline(0.0, 6.0).corners;
    ASSERT_EQ(corners.size(), wanted.size()) << text;
    for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(corners[i].time, wanted[i], 1e-14) << text;
  };
  expect_corners("trapezoid(t, 0.3, 2.3, 0.5)", {0.3, 0.8, 1.8, 2.3});
  expect_corners("s_curve(t, 1, 5, 1.5, 0.4)", {1.0, 1.4, 2.1, 2.5, 3.5, 3.9, 4.6, 5.0});
  expect_corners("sin(trapezoid(2*t, 1, 3, 0.5))", {0.5, 0.75, 1.25, 1.5});
}

TEST(SpeedLaw, MayBeConstantAndIsAPlainNumber) {
  const Expression formula = Expression::compile("5 mm*trapezoid(10 mm, 0 m, 20 mm, 1 cm)", NoParameters(), false);
  EXPECT_NEAR(formula.constant().value, 2.5e-3, 1e-17);
  EXPECT_EQ(formula.dimension(), dimension::length);
}

TEST(SpeedLaw, IsRefusedWhereItCannotBe) {
  const auto expect_refusal = [](std::string_view text, std::string_view place, std::string_view says) {
    const ExpressionError error = refusal(text);
    EXPECT_EQ(error.id, "bad-expression") << text;
    EXPECT_EQ(text.substr(static_cast<std::size_t>(error.offset), static_cast<std::size_t>(error.length)), place);
    EXPECT_NE(error.message.find(says), std::string::npos) << error.message;
  };
  expect_refusal("trapezoid(t, 1, 1, 0.1)", "1", "the end must be after the start");
  expect_refusal("trapezoid(t, 0, 1, 0.6)", "0.6", "at most half");
  expect_refusal("trapezoid(t, 0, 1, 0)", "0", "the ramp must be positive");
  expect_refusal("s_curve(t, 0, 1, 0.5, 0.3)", "0.3", "at most half of the ramp");
  expect_refusal("s_curve(t, 0, 1, 0.5, 0)", "0", "the rise must be positive");
  expect_refusal("trapezoid(t, 0, t, 0.1)", "t", "must be constant");
  expect_refusal("trapezoid(t, 0, 1)", "trapezoid(t, 0, 1)", "needs 4 arguments");
  expect_refusal("trapezoid", "trapezoid", "in parentheses");
  EXPECT_EQ(refusal("trapezoid(t, 0, 1, 0.1, 0.05)").id, "bad-expression");
  EXPECT_EQ(refusal("trapezoid(t, 0 s, 1 m, 0.1 s)").id, "dimension-mismatch");
  EXPECT_EQ(refusal("trapezoidal(t, 0, 1, 0.1)").suggestion, "trapezoid");
  std::string nested = "t";
  for (int i = 0; i < 9; ++i) nested = fmt::format("s_curve({}, 0, 1, 0.5)", nested);
  EXPECT_EQ(refusal(nested).id, "bad-expression");
}

}  // namespace
}  // namespace freeplay
