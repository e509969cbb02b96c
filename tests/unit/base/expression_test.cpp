#include "base/expression.h"

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

constexpr double pi = 3.14159265358979323846;

class KnownParameters : public Scope {
 public:
  const Quantity* find(std::string_view name) const override {
    const auto found = values_.find(name);
    return found == values_.end() ? nullptr : &found->second;
  }
  std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const auto& [name, value] : values_) all.push_back(name);
    return all;
  }

 private:
  std::map<std::string, Quantity, std::less<>> values_ = {
      {"l1", {0.24, DimensionKind::dimensioned, dimension::length}},
      {"m1", {3.0, DimensionKind::dimensioned, dimension::mass}},
      {"ratio", {0.5, DimensionKind::plain, {}}},
  };
};

Expression compiled(std::string_view text) { return Expression::compile(text, KnownParameters(), true); }
double value(std::string_view text) { return Expression::compile(text, KnownParameters(), false).constant().value; }

Jet at(std::string_view text, double t) {
  Jet jet;
  EvaluationFailure failure;
  EXPECT_TRUE(compiled(text).evaluate(t, jet, failure)) << text << ": " << failure.reason;
  return jet;
}

EvaluationFailure failure_at(std::string_view text, double t) {
  Jet jet;
  EvaluationFailure failure;
  EXPECT_FALSE(compiled(text).evaluate(t, jet, failure)) << text;
  return failure;
}

ExpressionError error_of(std::string_view text, bool time_allowed = true) {
  try {
    Expression::compile(text, KnownParameters(), time_allowed);
  } catch (const ExpressionError& error) {
    return error;
  }
  return {"accepted", std::string(text), -1, -1};
}

void expect_kind(std::string_view text, DimensionKind kind, const Dimension& dimension = {}) {
  const Expression expression = compiled(text);
  EXPECT_EQ(expression.kind(), kind) << text;
  EXPECT_EQ(kind == DimensionKind::dimensioned ? expression.dimension() : dimension, dimension) << text;
}

TEST(Expression, ReadsEveryFormOfANumber) {
  EXPECT_EQ(value("0.5"), 0.5);
  EXPECT_EQ(value(".5"), 0.5);
  EXPECT_EQ(value("5."), 5.0);
  EXPECT_EQ(value("1e3"), 1000.0);
  EXPECT_EQ(value("2.5E-1"), 0.25);
  EXPECT_EQ(value("010"), 10.0);
  EXPECT_EQ(value("1e-999"), 0.0);
  EXPECT_EQ(value("1." + std::string(300, '0')), 1.0);
  EXPECT_EQ(value("pi"), pi);
}

TEST(Expression, FollowsPrecedence) {
  EXPECT_EQ(value("1 + 2*3 - 4/2"), 5.0);
  EXPECT_EQ(value("10 - 2 - 3"), 5.0);
  EXPECT_EQ(value("8/2/2"), 2.0);
  EXPECT_EQ(value("-2^2"), -4.0);
  EXPECT_EQ(value("2^3^2"), 512.0);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("2^-2^2"), 0.0625);
  EXPECT_EQ(value("-+-3"), 3.0);
  EXPECT_EQ(value("2*-3"), -6.0);
  EXPECT_EQ(value("(1 + 2) * 3"), 9.0);
  EXPECT_EQ(value("\t1\n+ 1 "), 2.0);
}

TEST(Expression, ConvertsUnitsToSI) {
  EXPECT_DOUBLE_EQ(value("240 mm"), 0.24);
  EXPECT_DOUBLE_EQ(value("5\u00b5m"), 5e-6);
  EXPECT_DOUBLE_EQ(value("30 deg"), pi / 6.0);
  EXPECT_DOUBLE_EQ(value("60 rpm"), 2.0 * pi);
  EXPECT_DOUBLE_EQ(value("2*$l1 + 1 mm"), 0.481);
  EXPECT_DOUBLE_EQ(value("(1/2) m"), 0.5);
  EXPECT_DOUBLE_EQ(value("3 m ^ 2"), 3.0);
}

TEST(Expression, DividesByANumberWithItsUnit) {
  EXPECT_DOUBLE_EQ(value("1/2 mm"), 500.0);
  expect_kind("1/2 m", DimensionKind::dimensioned, {0, -1, 0});
  EXPECT_DOUBLE_EQ(value("1 kg*m^2 / 12"), 1.0 / 12.0);
}

TEST(Expression, ContinuesAUnitOnlyWithAUnitName) {
  EXPECT_DOUBLE_EQ(value("2 m*mm"), 0.002);
  EXPECT_DOUBLE_EQ(value("2 m * pi"), 2.0 * pi);
  EXPECT_DOUBLE_EQ(at("2 m * t", 3.0).value, 6.0);
  EXPECT_DOUBLE_EQ(value("2 m * min(3, 4)"), 6.0);
  EXPECT_DOUBLE_EQ(value("6 m/$ratio"), 12.0);
}

TEST(Expression, EvaluatesFunctions) {
  EXPECT_DOUBLE_EQ(value("sin(30 deg)"), 0.5);
  EXPECT_DOUBLE_EQ(value("atan2(1, -1)"), 0.75 * pi);
  EXPECT_DOUBLE_EQ(value("sqrt(2 m * 8 m)"), 4.0);
  EXPECT_DOUBLE_EQ(value("log(exp(2))"), 2.0);
  EXPECT_DOUBLE_EQ(value("max(1, 5, 3) - min(4, 2, 6, 3)"), 3.0);
  EXPECT_DOUBLE_EQ(value("smooth(0.5, 0, 1)"), 0.5);
  EXPECT_DOUBLE_EQ(value("abs(-2 m)"), 2.0);
  EXPECT_DOUBLE_EQ(value("acos(0) + asin(1) + tan(0) + cos(0)"), pi + 1.0);
}

TEST(Expression, RefersToParameters) {
  EXPECT_DOUBLE_EQ(value("$l1/2"), 0.12);
  EXPECT_DOUBLE_EQ(value("${l1}*${ m1 }"), 0.72);
  const ExpressionError error = error_of("1 + $l2");
  EXPECT_EQ(error.id, "unknown-name");
  EXPECT_EQ(error.offset, 4);
  EXPECT_EQ(error.length, 3);
  EXPECT_EQ(error.suggestion, "l1");
  EXPECT_EQ(error_of("$t").id, "unknown-name");
  EXPECT_EQ(error_of("l1 * 2").hint, "write '$l1' for the parameter");
}

TEST(Expression, ListsReferencedParametersOfAnyText) {
  const std::vector<std::string> expected = {"a", "b_2", "c"};
  EXPECT_EQ(referenced_parameters("$a + (${b_2} * $a $$ ${ c"), expected);
  EXPECT_TRUE(referenced_parameters("1 $").empty());
}

TEST(Expression, DerivesAMotionInClosedForm) {
  // 0.1 sin(w t), w = 2 pi
  const double w = 2.0 * pi, t = 0.3;
  const Jet jet = at("0.1*sin(2*pi*t)", t);
  EXPECT_NEAR(jet.value, 0.1 * std::sin(w * t), 1e-15);
  EXPECT_NEAR(jet.rate, 0.1 * w * std::cos(w * t), 1e-15);
  EXPECT_NEAR(jet.acceleration, -0.1 * w * w * std::sin(w * t), 1e-14);
}

TEST(Expression, DerivativesAgreeWithDifferences) {
  const double h = 1e-4;  // truncation and round-off of the second difference are both of order 1e-8
  for (const char* text : {"t^3 - 2*t^0.5", "exp(-t)*cos(3*t)/(1 + t^2)", "2^t * t^t", "atan2(sin(t), t + 1)",
                           "smooth(t, 0.2, 1.7)*abs(t - 2)", "max(t, 1 - t, 0.1*t)", "sqrt(1 + asin(t/2)^2)",
                           "log(2 + tan(t/3))*acos(t/4)", "-t^2^0.5", "(min(t^2, 3)) mm", "$l1*sin(2 rad/s*t)"}) {
    const double t = 0.8;
    const Jet jet = at(text, t);
    const double left = at(text, t - h).value, right = at(text, t + h).value;
    EXPECT_NEAR(jet.rate, (right - left) / (2.0 * h), 1e-6) << text;
    EXPECT_NEAR(jet.acceleration, (right - 2.0 * jet.value + left) / (h * h), 1e-5) << text;
  }
}

TEST(Expression, FoldsConstants) {
  EXPECT_FALSE(compiled("2*(3 + $l1)^2").depends_on_time());
  EXPECT_TRUE(compiled("0*t").depends_on_time());
  const Jet jet = at("7", 5.0);
  EXPECT_EQ(jet.value, 7.0);
  EXPECT_EQ(jet.rate, 0.0);
}

TEST(Expression, ReportsDomainErrorsWhileReading) {
  for (const char* text : {"1/0", "sqrt(-1)", "log(0)", "asin(2)", "acos(-1.1)", "(-2)^0.5", "0^-1", "smooth(1, 2, 2)",
                           "1/(2 - 2)", "atan2(0, 0)"}) {
    EXPECT_EQ(error_of(text).id, "bad-expression") << text;
  }
  EXPECT_EQ(error_of("3 + 1/0").offset, 5);
}

TEST(Expression, ReportsDomainErrorsInTime) {
  Jet jet{1.0, 2.0, 3.0};
  EvaluationFailure failure;
  EXPECT_FALSE(compiled("1/(t - 1)").evaluate(1.0, jet, failure));
  EXPECT_STREQ(failure.reason, "division by zero");
  EXPECT_EQ(failure.offset, 1);
  EXPECT_EQ(jet.value, 1.0);
  EXPECT_STREQ(failure_at("sqrt(1 - t)", 2.0).id, "bad-expression");
  EXPECT_STREQ(failure_at("sqrt(t)", 0.0).reason, "a time derivative is not finite");
  EXPECT_STREQ(failure_at("exp(t)", 1000.0).id, "bad-number");
  EXPECT_STREQ(failure_at("exp(-exp(t))", 1000.0).id, "bad-number");
  EXPECT_STREQ(failure_at("(-2)^t", 1.0).id, "bad-expression");
  EXPECT_STREQ(failure_at("smooth(t, 1, t)", 0.5).id, "bad-expression");
}

TEST(Expression, RefusesInfinityAndNanInAnySpelling) {
  for (const char* text :
       {"inf", ".inf", "-.INF", "nan", "NaN", ".nan", "Infinity", "1e999", "2*1e400", "1e308*10", "10^400"}) {
    EXPECT_EQ(error_of(text).id, "bad-number") << text;
  }
}

TEST(Expression, RefusesWhatIsNotAnExpression) {
  for (const char* text :
       {"",           "  ",    "1 +",       "* 2",    "()",           "(1",        "1)",    "2 3 mm", "2(3)", "2 $l1",
        "sin 3",      "sin()", "sin(1, 2)", "min(1)", "smooth(1, 2)", "foo(1)",    "word",  "$",      "${l1", "1_000",
        "0x1F",       "0o17",  "mm",        "2 pi",   "$l1 mm",       "sin(1) mm", "1 , 2", "~",      "1..2", "2 ** 3",
        "1 \u2212 2", "true",  "#",         "2^",     "'1'",          "1 ; 2",     "\xff"}) {
    EXPECT_EQ(error_of(text).id, "bad-expression") << text;
  }
}

TEST(Expression, RefusesUnknownUnits) {
  EXPECT_EQ(error_of("3 gramm").id, "bad-unit");
  EXPECT_EQ(error_of("3 gramm").offset, 2);
  EXPECT_EQ(error_of("3 gramm").length, 5);
  EXPECT_EQ(error_of("3 KG").suggestion, "kg");
  EXPECT_EQ(error_of("5 Hz").hint, "write 'rev/s' or 'rad/s'");
  EXPECT_EQ(error_of("5 rad*Hz").hint, "write 'rev/s' or 'rad/s'");
  EXPECT_EQ(error_of("(2 m) m").id, "bad-unit");
}

TEST(Expression, SaysWhatToWriteForUnitsThatAreInUseElsewhere) {
  for (const auto& [text, hint] :
       {std::pair("7 bar", "write '100 kPa' for each 'bar'"), std::pair("2 hp", "write '745.6999 W' for each 'hp'"),
        std::pair("1 min", "write '60 s' for each 'min'"), std::pair("180 1/min", "write 'rpm'")}) {
    EXPECT_EQ(error_of(text).id, "bad-unit") << text;
    EXPECT_EQ(error_of(text).hint, hint);
    EXPECT_EQ(error_of(text).suggestion, "");
  }
  EXPECT_EQ(error_of("180 rev/min").hint, "of revolutions per minute write 'rpm', of a minute '60 s'");
  EXPECT_EQ(error_of("2 min(1, 2)").id, "bad-expression");
}

TEST(Expression, PointsIntoTheTextInCharacters) {
  EXPECT_EQ(error_of("5 \u00b5m + foo").offset, 7);
  EXPECT_EQ(error_of("6.75e-3*(1 + $l1").offset, 8);
  EXPECT_EQ(error_of("1 + 6,75e-3").offset, 4);  // the number, not its comma
  EXPECT_EQ(error_of("6,75e-3").hint, "write a decimal point, as in '0.5'");
  EXPECT_EQ(error_of("sin(0,5)").hint, "write a decimal point, as in '0.5'");
}

TEST(Expression, AllowsTimeOnlyWhereItIsAskedFor) {
  const ExpressionError error = error_of("2*t", false);
  EXPECT_EQ(error.id, "time-not-allowed");
  EXPECT_EQ(error.offset, 2);
}

TEST(Expression, TracksDimensions) {
  using enum DimensionKind;
  expect_kind("2*pi", plain);
  expect_kind("t", free);
  expect_kind("$ratio", free);
  expect_kind("2 m", dimensioned, dimension::length);
  expect_kind("2 m * $ratio", free);
  expect_kind("2 m * 3", dimensioned, dimension::length);
  expect_kind("2 m / 3 s", dimensioned, dimension::velocity);
  expect_kind("2 m + $ratio", dimensioned, dimension::length);
  expect_kind("1 + $ratio", free);
  expect_kind("max(1, 2 m)", dimensioned, dimension::length);
  expect_kind("sin(2*t)", plain);
  expect_kind("60 mm * smooth(t, 0, 1)", dimensioned, dimension::length);
  expect_kind("atan2(1 m, 2 m)", plain);
  expect_kind("sqrt(4 m^3)", dimensioned, {0, 1.5, 0});
  expect_kind("$l1^2", dimensioned, dimension::area);
  expect_kind("2^$ratio", free);
  expect_kind("$l1/$l1", dimensioned, dimension::none);
  expect_kind("30 deg", dimensioned, dimension::none);
}

TEST(Expression, RefusesMixedDimensions) {
  for (const char* text : {"1 m + 1 s", "$l1 - $m1", "min(1 m, 1 kg)", "sin(1 m)", "atan2(1 m, 1 s)", "2^(1 m)",
                           "2^(1 rad)", "$l1^$ratio", "$l1^sin(t)", "smooth(t, 1 m, 1 s)", "30 deg + 1 m"}) {
    EXPECT_EQ(error_of(text).id, "dimension-mismatch") << text;
  }
}

TEST(Expression, FitsAFieldByItsDimension) {
  EXPECT_NO_THROW(compiled("30 deg").require(dimension::angle));
  EXPECT_NO_THROW(compiled("3").require(dimension::length));
  EXPECT_NO_THROW(compiled("$ratio").require(dimension::mass));
  try {
    compiled("30 deg").require(dimension::length);
    FAIL();
  } catch (const ExpressionError& error) {
    EXPECT_EQ(error.id, "dimension-mismatch");
    EXPECT_EQ(error.message, "expected length, but this is angle or number");
    EXPECT_EQ(error.length, 6);
    EXPECT_EQ(error.hint, "write a unit such as 'm'");
  }
}

TEST(Expression, KeepsItsLimits) {
  const auto nested = [](std::size_t n) { return std::string(n, '(') + "1" + std::string(n, ')'); };
  EXPECT_EQ(value(nested(256)), 1.0);
  EXPECT_EQ(error_of(nested(257)).id, "bad-expression");
  EXPECT_EQ(value(std::string(9999, '-') + "1"), -1.0);
  EXPECT_EQ(error_of(std::string(10000, '-') + "1").id, "bad-expression");
}

TEST(Expression, EvaluatesTheDeepestStack) {
  std::string tower = "1";  // 1^1^...^t is 1
  for (int i = 0; i < 4998; ++i) tower += "^1";
  EXPECT_EQ(at(tower + "^t", 2.0).value, 1.0);
  std::string powers = "t";
  for (int i = 0; i < 4999; ++i) powers += "^t";
  EXPECT_EQ(at(powers, 1.0).value, 1.0);
}

/// Times of its corners: sharp ones, or ends of ramps.
std::vector<double> corners(std::string_view text, bool smooth = false) {
  std::vector<double> times;
  for (const Corner& corner : compiled(text).outline(0.0, 1.0).corners) {
    if (corner.smooth == smooth) times.push_back(corner.time);
  }
  return times;
}

void expect_times(const std::vector<double>& found, const std::vector<double>& wanted, std::string_view text) {
  ASSERT_EQ(found.size(), wanted.size()) << text;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-15) << text;
}

void expect_kinks(std::string_view text, const std::vector<double>& wanted) {
  expect_times(corners(text), wanted, text);
}

TEST(ExpressionOutline, HasKinksWhereSidesChange) {
  expect_kinks("abs(t - 0.3)", {0.3});
  expect_kinks("min(1, 2*t) + max(0, t - 0.7, 3*t - 2.7)", {0.5, 0.7});
  expect_kinks("abs(sin(10*t))", {0.1 * pi, 0.2 * pi, 0.3 * pi});
  expect_kinks("smooth(max(t, 0.25), 0, 1)", {0.25});
}

TEST(ExpressionOutline, HasBothEndsOfEverySmoothRamp) {
  const char* const text = "1000*smooth(t, 0.5, 0.501)*(1 - smooth(t, 0.502, 0.5021))";
  expect_times(corners(text, true), {0.5, 0.501, 0.502, 0.5021}, text);
  expect_kinks(text, {});
  expect_times(corners("smooth(abs(t - 0.5), 0.1, 0.2)", true), {0.3, 0.4, 0.6, 0.7}, "of an abs");
  expect_kinks("smooth(abs(t - 0.5), 0.1, 0.2)", {0.5});
}

// Pieces between inner corners are straight, however short they are.
TEST(ExpressionOutline, FindsShortPulsesOfNestedFunctions) {
  expect_kinks("max(0, 1 - abs(t - 0.5)/1e-7)", {0.5 - 1e-7, 0.5, 0.5 + 1e-7});
  expect_kinks("min(max(0, t - 0.3), max(0, 0.3 + 2e-8 - t))*1e9", {0.3, 0.3 + 1e-8, 0.3 + 2e-8});
  expect_kinks("max(0, 1e-14 - (t - 0.500001)^2)", {0.500001 - 1e-7, 0.500001 + 1e-7});
  expect_kinks("t*max(0, 1 - abs(max(t, 0.2) - 0.5)/1e-6)", {0.2, 0.5 - 1e-6, 0.5, 0.5 + 1e-6});
}

TEST(ExpressionOutline, SeesWhatComesAndGoesBetweenLooksByItsRates) {
  const double half = std::sqrt(1e-10);
  const std::vector<double> found = corners("max(0, 1e-10 - sin(t - 0.5001)^2)");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0], 0.5001 - half, 1e-11);
  EXPECT_NEAR(found[1], 0.5001 + half, 1e-11);
}

TEST(ExpressionOutline, HasNoCornerWhereASideIsOnlyTouched) {
  expect_kinks("abs((t - 0.3)^2)", {});
  expect_kinks("sin(t) + abs(2)", {});
  expect_kinks("max(t, t)", {});
}

// Left of it the formula is what it was, so that a step can end there.
TEST(ExpressionOutline, CornersAreTheFirstInstantsOfTheOtherSide) {
  const double kink = corners("abs(t - 0.3)").at(0);
  EXPECT_EQ(at("abs(t - 0.3)", std::nextafter(kink, 0.0)).rate, -1.0);
  EXPECT_EQ(at("abs(t - 0.3)", kink).rate, 1.0);
}

TEST(ExpressionOutline, FindsEveryCornerOfManyPeriods) {
  EXPECT_EQ(corners("abs(sin(2*pi*1000*(t + 1e-5)))").size(), 2000u);
}

TEST(ExpressionOutline, KnowsHowFastPiecesMayChange) {
  const auto rates = [](std::string_view text) { return compiled(text).outline(0.0, 1.0).rates; };
  const double unknown = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rates("3*t^2 - 2*t + 1"), std::vector<double>{0.0});
  EXPECT_EQ(rates("t*sin(5*t + 1)"), std::vector<double>{5.0});
  EXPECT_EQ(rates("exp(-2*t)*sin(5*t)*cos(t)"), std::vector<double>{8.0});
  EXPECT_EQ(rates("exp(-((t - 0.5)/1e-3)^2)"), std::vector<double>{unknown});
  EXPECT_EQ(rates("(1 - (t - 0.5)^2)^100"), std::vector<double>{unknown});
  EXPECT_EQ(rates("1/(1 + t^2)"), std::vector<double>{unknown});
  EXPECT_EQ(rates("sin(100*max(0, t - 0.5))"), (std::vector<double>{0.0, 100.0}));
  EXPECT_EQ(rates("smooth(t, 0.2, 0.4)"), (std::vector<double>{0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace freeplay
