// What a formula can come to where its variables stay in ranges.
#include "base/formula_bounds.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace freeplay::test {
namespace {

class TwoWords final : public FormulaVariables {
 public:
  std::optional<FormulaVariable> find(std::string_view name) const override {
    if (name == "x") return FormulaVariable{0};
    if (name == "v") return FormulaVariable{1};
    return std::nullopt;
  }
  bool plain() const override { return true; }
  std::string word() const override { return "variable"; }
  std::string nearest(std::string_view) const override { return {}; }
};

constexpr const char* formulas[] = {"(2 + 3*abs(x))*x - 4*v",
                                    "x^2*v - x/(v^2 + 1)",
                                    "sin(3*x)*exp(-v)",
                                    "if(x > v, x^3, -2*v + 1)",
                                    "if(x*v <= 0.1, 1, x)",
                                    "max(x, v, 0)*min(x, 2)",
                                    "sign(x - v)*v",
                                    "smooth(x, -0.5, 0.5)*v",
                                    "tanh(5*x) + cos(v)",
                                    "atan2(x, v)",
                                    "sqrt(x^2 + v^2)*log(3 + x)",
                                    "2^sin(v) - x*t"};

TEST(FormulaBounds, ValuesInRangesAreWithinTheirBounds) {
  std::mt19937 draw(4);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(draw()) / 4294967296.0;
  };
  for (const char* text : formulas) {
    const StateFormula formula(Expression::compile(text, EmptyScope(), true, TwoWords()));
    const FormulaBounds bounds(formula);
    for (int i = 0; i < 200; ++i) {
      const double x = uniform(-2.0, 2.0), v = uniform(-2.0, 2.0), wide = std::pow(10.0, uniform(-4.0, 0.0));
      const std::vector<Interval> ranges = {{x - wide, x + wide}, {v - wide, v + wide}};
      const Interval range = bounds.values(ranges, {1.0, 1.0 + wide});
      for (int k = 0; k < 20; ++k) {
        const double at[] = {uniform(ranges[0].low, ranges[0].high), uniform(ranges[1].low, ranges[1].high)};
        double value = 0.0;
        EvaluationFailure ignored;
        if (!formula.value({uniform(1.0, 1.0 + wide), at, nullptr}, value, ignored)) continue;
        EXPECT_LE(range.low, value + 1e-12) << text;
        EXPECT_GE(range.high, value - 1e-12) << text;
      }
    }
  }
}

// Products, sums and switches of one variable have the bounds that its ends and zeros give.
TEST(FormulaBounds, AreAsNarrowAsAFormulaOfOnePlaceAllows) {
  const auto range_of = [](const char* text, double low, double high) {
    const StateFormula formula(Expression::compile(text, EmptyScope(), true, TwoWords()));
    const std::vector<Interval> ranges = {{low, high}, {0.0, 0.0}};
    return FormulaBounds(formula).values(ranges, {0.0, 0.0});
  };
  const auto expect = [&](const char* text, double low, double high, double least, double most) {
    const Interval range = range_of(text, low, high);
    EXPECT_DOUBLE_EQ(range.low, least) << text;
    EXPECT_DOUBLE_EQ(range.high, most) << text;
  };
  expect("abs(x)", -1.0, 3.0, 0.0, 3.0);
  expect("abs(x)", -3.0, -1.0, 1.0, 3.0);
  expect("sign(x)", -1.0, 3.0, -1.0, 1.0);
  expect("sign(x)", 1.0, 3.0, 1.0, 1.0);
  expect("max(x, 1)", -1.0, 3.0, 1.0, 3.0);
  expect("min(x, 1)", -1.0, 3.0, -1.0, 1.0);
  expect("if(x > 2, 10, 20)", 3.0, 4.0, 10.0, 10.0);
  expect("if(x > 2, 10, 20)", 0.0, 1.0, 20.0, 20.0);
  expect("if(x > 2, 10, 20)", 1.0, 3.0, 10.0, 20.0);
  expect("(50 + 10*abs(x))*x", 1.0, 2.0, 60.0, 140.0);
}

TEST(FormulaBounds, AnAngleJumpsWhereItPassesTheHalfLineToTheLeft) {
  const StateFormula formula(Expression::compile("atan2(x, v)", EmptyScope(), true, TwoWords()));
  const auto bounded = [&](double v) {  // x passes zero by 1 a second
    const std::vector<IntervalJet> ranges = {{{-0.1, 0.1}, Interval::at(1.0), {}},
                                             IntervalJet::constant(Interval::at(v))};
    const std::vector<Jet> at_middle = {Jet::time(0.0), Jet::constant(v)};
    FormulaBounds::Bounds out;
    FormulaBounds(formula).bound({0.0, 0.1, ranges, at_middle, nullptr}, out, {});
    return out.range;
  };
  const IntervalJet left = bounded(-1.0), right = bounded(1.0);
  EXPECT_DOUBLE_EQ(left.value.low, -M_PI);
  EXPECT_DOUBLE_EQ(left.value.high, M_PI);
  EXPECT_FALSE(left.rate.is_finite());
  EXPECT_NEAR(right.value.low, -std::atan(0.1), 1e-3);
  EXPECT_NEAR(right.value.high, std::atan(0.1), 1e-3);
  EXPECT_TRUE(right.rate.is_finite());
}

}  // namespace
}  // namespace freeplay::test
