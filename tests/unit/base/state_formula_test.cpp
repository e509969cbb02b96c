#include "base/state_formula.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// body.a.x [m], body.a.vx [m/s] and body.a-b.x [m].
class BodyChannels final : public FormulaVariables {
 public:
  std::optional<FormulaVariable> find(std::string_view name) const override {
    if (name == "body.a.x") return FormulaVariable{0, DimensionKind::dimensioned, dimension::length};
    if (name == "body.a.vx") return FormulaVariable{1, DimensionKind::dimensioned, dimension::velocity};
    if (name == "body.a-b.x") return FormulaVariable{2, DimensionKind::dimensioned, dimension::length};
    return std::nullopt;
  }
  std::string word() const override { return "channel"; }
  std::string nearest(std::string_view) const override { return "body.a.x"; }
};

Expression formula_of(std::string_view text) { return Expression::compile(text, EmptyScope(), true, BodyChannels()); }

struct Numbers {
  double x = 0.0, v = 0.0, other = 0.0, t = 0.0;
  std::vector<double> sides = {};
};

double value(const std::string& text, const Numbers& at) {
  const StateFormula formula(formula_of(text));
  const std::vector<double> variables = {at.x, at.v, at.other};
  double out = std::nan("");
  EvaluationFailure failure;
  EXPECT_TRUE(formula.value({at.t, variables, at.sides.empty() ? nullptr : at.sides.data()}, out, failure))
      << text << ": " << failure.reason;
  return out;
}

double rate(const std::string& text, const Numbers& at, const std::vector<double>& rates, double time_rate = 0.0) {
  const std::vector<double> variables = {at.x, at.v, at.other};
  return StateFormula(formula_of(text))
      .rate({at.t, variables, at.sides.empty() ? nullptr : at.sides.data()}, rates, time_rate);
}

std::string formula_error(std::string_view text) {
  try {
    formula_of(text);
  } catch (const ExpressionError& error) {
    return error.id + " " + std::to_string(error.offset) + "+" + std::to_string(error.length);
  }
  return "accepted";
}

TEST(StateFormula, NamesChannelsAndChecksTheirUnits) {
  EXPECT_EQ(value("(50 N/m + 10 N/m^2*abs(body.a.x))*body.a.x", {.x = -0.3}), -(50.0 + 3.0) * 0.3);
  EXPECT_EQ(value("body.a.x-body.a-b.x", {.x = 1.0, .other = 0.25}), 0.75);
  EXPECT_EQ(value("body.a-b.x/2", {.other = 0.5}), 0.25);
  EXPECT_EQ(value("[body.a.x]*2", {.x = 0.5}), 1.0);
  EXPECT_EQ(formula_of("3 N*s/m*body.a.vx").dimension(), dimension::force);
  EXPECT_EQ(formula_error("body.a.x + body.a.vx"), "dimension-mismatch 0+20");
  EXPECT_EQ(formula_error("2*body.a.y"), "unknown-name 2+8");
  EXPECT_EQ(formula_error("2*body.a-b.y-body.a.x"), "unknown-name 2+10");
  EXPECT_EQ(formula_error("if(body.a.x, 1, 2)"), "bad-expression 3+8");
  EXPECT_EQ(formula_error("if(body.a.x > 1, 2)"), "bad-expression 0+18");
  EXPECT_EQ(formula_error("if(body.a.x > 1 s, 2, 3)"), "dimension-mismatch 3+14");
  EXPECT_EQ(formula_error("body.a.x > 1"), "bad-expression 9+1");
}

TEST(StateFormula, ChoosesAndNeedsNoValueOfWhatIsLeftOut) {
  const std::string root = "if(body.a.x > 0, sqrt(body.a.x*1 m), -1 m)";
  EXPECT_EQ(value(root, {.x = 4.0}), 2.0);
  EXPECT_EQ(value(root, {.x = -4.0}), -1.0);
  EXPECT_EQ(value("if(body.a.x >= 0, 1, 2)", {.x = 0.0}), 1.0);
  EXPECT_EQ(value("if(body.a.x > 0, 1, 2)", {.x = 0.0}), 2.0);
  EXPECT_EQ(value("if(body.a.x <= 0, 1, 2)", {.x = 0.0}), 1.0);
  EXPECT_EQ(value("if(body.a.x < 0, 1, 2)", {.x = 0.0}), 2.0);
  EXPECT_EQ(value("if(t < 1, 1, 1/(t - 0.5))", {.t = 0.5}), 1.0);
  double out = 0.0;
  EvaluationFailure failure;
  const std::vector<double> variables = {-4.0, 0.0, 0.0};
  const StateFormula formula(formula_of("2 + sqrt(body.a.x)"));
  EXPECT_FALSE(formula.value({0.0, variables, nullptr}, out, failure));
  EXPECT_STREQ(failure.reason, "square root of a negative number");
  EXPECT_EQ(failure.offset, 4);
}

TEST(StateFormula, KeepsTheSideThatItIsGiven) {
  EXPECT_EQ(StateFormula(formula_of("abs(body.a.x) + sign(body.a.vx) + abs(t)")).switches(), 2);
  EXPECT_EQ(value("abs(body.a.x)", {.x = -2.0, .sides = {1.0}}), -2.0);
  EXPECT_EQ(value("sign(body.a.vx)", {.v = -2.0, .sides = {1.0}}), 1.0);
  EXPECT_EQ(value("min(body.a.x, 1 m)", {.x = 3.0, .sides = {-1.0}}), 3.0);
  EXPECT_EQ(value("max(body.a.x, 1 m)", {.x = 3.0, .sides = {-1.0}}), 1.0);
  EXPECT_EQ(value("if(body.a.x < 0, 1, 2)", {.x = 3.0, .sides = {1.0}}), 1.0);
  EXPECT_EQ(value("abs(body.a.x)", {.x = -2.0, .sides = {0.0}}), 2.0);
  // Where the form of its side has no value the formula itself may have one.
  EXPECT_EQ(value("sqrt(max(0 m, body.a.x))", {.x = -3.0, .sides = {1.0}}), 0.0);
}

// d/ds of 3 x |v| + sin(t x) where x' = 2, v' = -1, t' = 1.
TEST(StateFormula, HasExactRates) {
  const std::string text = "3*body.a.x*abs(body.a.vx) + 1 m^2/s*sin(t*body.a.x/1 m)";
  const double x = 0.4, v = -0.7, t = 1.3;
  const double want = 3.0 * 2.0 * std::abs(v) + 3.0 * x * 1.0 + std::cos(t * x) * (x + t * 2.0);
  EXPECT_NEAR(rate(text, {.x = x, .v = v, .t = t}, {2.0, -1.0, 0.0}, 1.0), want, 1e-15);
  EXPECT_EQ(rate("abs(body.a.x)", {.x = -1.0, .sides = {1.0}}, {2.0, 0.0, 0.0}), 2.0);
  EXPECT_EQ(rate("sqrt(abs(body.a.x))", {.x = 0.0}, {1.0, 0.0, 0.0}), 0.0);  // infinite: nothing that could be used
}

TEST(StateFormula, SaysWhatDecidesItsForm) {
  const StateFormula formula(formula_of("if(body.a.x > 2 m, max(body.a.vx, 1 m/s), 0)"));
  const std::vector<double> variables = {5.0, 0.25, 0.0}, rates = {0.5, 4.0, 0.0};
  std::vector<double> values(2), changes(2);
  formula.decide({0.0, variables, nullptr}, rates, 1.0, values, changes);
  EXPECT_EQ(values, (std::vector<double>{-0.75, 3.0}));
  EXPECT_EQ(changes, (std::vector<double>{4.0, 0.5}));
  EXPECT_EQ(formula.side_at_zero(1, 0.0), -1.0);  // not more than 2 m
  EXPECT_EQ(formula.side_at_zero(1, 3.0), 1.0);
}

TEST(TimeParts, AreTheLargestPartsWithoutChannels) {
  EXPECT_EQ(formula_of("sin(t) + abs(t - 1)").time_parts().size(), 1u);
  EXPECT_EQ(formula_of("body.a.x*2").time_parts().size(), 0u);
  const auto parts = formula_of("abs(t - 1)*body.a.x + min(body.a.vx*1 s, 2*t + 1)").time_parts();
  ASSERT_EQ(parts.size(), 2u);
  Jet out;
  EvaluationFailure failure;
  ASSERT_TRUE(parts[0].evaluate(0.25, out, failure));
  EXPECT_EQ(out.value, 0.75);
  EXPECT_EQ(parts[0].outline(0.0, 2.0).corners.size(), 1u);
  ASSERT_TRUE(parts[1].evaluate(0.25, out, failure));
  EXPECT_EQ(out.value, 1.5);
}

TEST(ChoiceInTime, HasItsCornersAndTheSideFromTheRight) {
  const Expression expression = Expression::compile("if(t < 1, 2, sign(t - 3))", EmptyScope(), true);
  Jet out;
  EvaluationFailure failure;
  for (const auto& [t, want] : {std::pair(0.5, 2.0), std::pair(1.0, -1.0), std::pair(2.0, -1.0), std::pair(3.0, 1.0)}) {
    ASSERT_TRUE(expression.evaluate(t, out, failure));
    EXPECT_EQ(out.value, want) << t;
  }
  const Outline outline = expression.outline(0.0, 4.0);
  ASSERT_EQ(outline.corners.size(), 2u);
  EXPECT_DOUBLE_EQ(outline.corners[0].time, 1.0);
  EXPECT_DOUBLE_EQ(outline.corners[1].time, 3.0);
  EXPECT_FALSE(outline.corners[0].smooth);
}

/// x [m] and v [m/s] as plain words.
class Words final : public FormulaVariables {
 public:
  std::optional<FormulaVariable> find(std::string_view name) const override {
    if (name == "x") return FormulaVariable{0, DimensionKind::dimensioned, dimension::length};
    if (name == "v") return FormulaVariable{1, DimensionKind::dimensioned, dimension::velocity};
    return std::nullopt;
  }
  bool plain() const override { return true; }
  std::string word() const override { return "variable"; }
  std::string nearest(std::string_view) const override { return "x"; }
  std::string known() const override { return "it may hold x or v"; }
};

TEST(StateFormula, GivesAllPartialDerivativesAtOnce) {
  for (const char* text :
       {"(2 N/m + 3 N/m^2*abs(x))*x - 4 N*s/m*v", "x^1.5*v/x^0.5 + x*v^2/(3 m/s)", "tanh(x/(1 m))*exp(-v/(3 m/s))",
        "atan2(x, v*1 s) + sin(x/(1 m))^3", "if(v > 1 m/s, x*v, x^2/(1 s))", "max(x, v*1 s)*min(x, v*1 s)",
        "smooth(x, 0 m, 1 m)*v", "sqrt(x)*log(v/(1 m/s))", "asin(x/(2 m)) + acos(x/(3 m)) + tan(x/(1 m))",
        "2^sin(v/(1 m/s))", "-x"}) {
    const StateFormula formula(Expression::compile(text, EmptyScope(), false, Words()));
    const std::vector<double> at = {0.7, 0.4};
    double value = 0.0, want = 0.0, slopes[4] = {};
    EvaluationFailure failure;
    ASSERT_TRUE(formula.value({0.0, at, nullptr}, want, failure)) << text;
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
      ASSERT_TRUE(formula.slopes({0.0, at, nullptr}, value, {slopes, count}, failure)) << text;
      EXPECT_NEAR(value, want, 2e-16 * std::abs(want)) << text;
      for (std::size_t k = 0; k < std::min<std::size_t>(count, 2); ++k) {
        std::vector<double> unit = {0.0, 0.0};
        unit[k] = 1.0;
        const double rate = formula.rate({0.0, at, nullptr}, unit, 0.0);
        EXPECT_NEAR(slopes[k], rate, 1e-14 * (1.0 + std::abs(rate))) << text << " by " << k;
      }
    }
  }
}

TEST(StateFormula, ReadsPlainWordsAndNumbersThatFitAnyUnit) {
  const auto error = [](std::string_view text) {
    try {
      Expression::compile(text, EmptyScope(), false, Words());
    } catch (const ExpressionError& e) {
      return e.id + " " + std::to_string(e.offset) + "+" + std::to_string(e.length) + " " + e.suggestion + e.hint;
    }
    return std::string("accepted");
  };
  EXPECT_EQ(error("x + y"), "unknown-name 4+1 xit may hold x or v");
  EXPECT_EQ(error("x + v"), "dimension-mismatch 0+5 ");
  EXPECT_EQ(error("x*t"), "time-not-allowed 2+1 it may hold x or v");
  EXPECT_EQ(error("x + [3]*v"), "accepted");
  EXPECT_EQ(error("x + [ 3.5 ]"), "accepted");
  EXPECT_EQ(error("2 x"), "bad-unit 2+1 ");
}

TEST(StateFormula, TanhStaysFiniteAndExact) {
  const StateFormula formula(Expression::compile("tanh(v/(1 mm/s))", EmptyScope(), false, Words()));
  for (const double v : {-30.0, -1e-3, 0.0, 1e-12, 2e-3, 1e6}) {
    const std::vector<double> at = {0.0, v};
    double value = 0.0, slopes[2];
    EvaluationFailure failure;
    ASSERT_TRUE(formula.slopes({0.0, at, nullptr}, value, slopes, failure));
    EXPECT_DOUBLE_EQ(value, std::tanh(v / 1e-3));
    EXPECT_NEAR(slopes[1], 1e3 * (1.0 - value * value), 1e-12);
  }
}

}  // namespace
}  // namespace freeplay
