#include "base/unit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/expression_error.h"

namespace freeplay {
namespace {

void expect_unit(const char* text, double factor, const Dimension& dimension) {
  const Unit unit = parse_unit(text);
  EXPECT_NEAR(unit.factor, factor, 1e-15 * factor) << text;
  EXPECT_EQ(unit.dimension, dimension) << text;
}

ExpressionError error_of(const char* text) {
  try {
    parse_unit(text);
  } catch (const ExpressionError& error) {
    return error;
  }
  return {"accepted", "", -1, -1};
}

TEST(Unit, KnowsEveryNameOfTheModelFormat) {
  expect_unit("in", 0.0254, dimension::length);
  expect_unit("\u00b5m", 1e-6, dimension::length);
  expect_unit("lb", 0.45359237, dimension::mass);
  expect_unit("\u00b5s", 1e-6, dimension::time);
  expect_unit("deg", M_PI / 180.0, dimension::angle);
  expect_unit("arcsec", M_PI / 180.0 / 3600.0, dimension::angle);
  expect_unit("rpm", 2.0 * M_PI / 60.0, dimension::angular_velocity);
  expect_unit("lbf", 0.45359237 * 9.80665, dimension::force);
  expect_unit("mNm", 1e-3, dimension::torque);
  expect_unit("GPa", 1e9, dimension::pressure);
  expect_unit("kJ", 1e3, dimension::energy);
  expect_unit("mW", 1e-3, dimension::power);
  EXPECT_EQ(unit_names().size(), 45u);
}

TEST(Unit, MultipliesDividesAndRaises) {
  expect_unit("kg*m^2", 1.0, dimension::moment_of_inertia);
  expect_unit("kg*mm^2", 1e-6, dimension::moment_of_inertia);
  expect_unit("rad/s", 1.0, dimension::angular_velocity);
  expect_unit("N/m^1.5", 1.0, {1, -0.5, -2});
  expect_unit("N*mm^-1", 1e3, dimension::stiffness);
  expect_unit(" N * s / mm ", 1e3, dimension::damping);
  expect_unit("N/mm/mm", 1e6, dimension::pressure);
  expect_unit("1", 1.0, dimension::none);
  expect_unit("1/s*m", 1.0, dimension::velocity);
}

TEST(Unit, TakesTheUnitThatAWordChooses) {
  const char* text = "kind: N/mm | N*m/rad";
  const auto word = [](double index) { return [index](std::string_view) { return std::optional(index); }; };
  EXPECT_EQ(parse_unit(text, word(0.0)).dimension, dimension::stiffness);
  EXPECT_NEAR(parse_unit(text, word(0.0)).factor, 1e3, 1e-10);
  EXPECT_EQ(parse_unit(text, word(1.0)).dimension, dimension::torque);
  EXPECT_EQ(parse_unit(text, [](std::string_view) { return std::optional<double>(); }).dimension, dimension::stiffness);
  EXPECT_EQ(error_of(text).id, "bad-unit");  // in a model file there is no such thing
}

TEST(Unit, TakesAnExponentFromANamedParameter) {
  const auto lookup = [](std::string_view name) { return name == "exponent" ? std::optional(1.5) : std::nullopt; };
  const auto nested = [](std::string_view name) { return name == "law.n" ? std::optional(2.0) : std::nullopt; };
  EXPECT_EQ(parse_unit("N/m^law.n*s", nested).dimension, (Dimension{1, -1, -1}));
  const Unit unit = parse_unit("N/mm^exponent", lookup);
  EXPECT_NEAR(unit.factor, 31622.776601683795, 1e-9);  // 10^4.5
  EXPECT_EQ(unit.dimension, (Dimension{1, -0.5, -2}));
  EXPECT_THROW(parse_unit("N/m^other", lookup), ExpressionError);
}

TEST(Unit, RefusesUnknownNamesWithAPlaceAndASuggestion) {
  const ExpressionError error = error_of("mm*Kg^2");
  EXPECT_EQ(error.id, "bad-unit");
  EXPECT_EQ(error.offset, 3);
  EXPECT_EQ(error.length, 2);
  EXPECT_EQ(error.suggestion, "kg");
  EXPECT_EQ(error_of("\u00b5m*foobar").offset, 3);  // characters, not bytes
  for (const char* bad : {"", "m^", "m^x", "m**s", "m/", "2", "12", "m s", "mm^1e300", "Pascal", "ohm"}) {
    EXPECT_EQ(error_of(bad).id, "bad-unit") << bad;
  }
}

TEST(Unit, RefusesAProductWhoseExponentsOverflow) {
  // N has s^-2: its power has s^-2e308, which no double holds.
  const ExpressionError error = error_of("m*N^1e308");
  EXPECT_EQ(error.id, "bad-unit");
  EXPECT_EQ(error.offset, 2);
  EXPECT_EQ(error.message, "the exponent of 'N' is too large");
}

TEST(Unit, RefusesHertzWithAHint) {
  EXPECT_EQ(error_of("Hz").id, "bad-unit");
  EXPECT_EQ(error_of("Hz").hint, "write 'rev/s' or 'rad/s'");
  EXPECT_EQ(error_of("m*Hz").hint, "write 'rev/s' or 'rad/s'");
}

TEST(Dimension, HasAName) {
  EXPECT_EQ(dimension_name(dimension::length), "length");
  EXPECT_EQ(dimension_name(dimension::moment_of_inertia), "moment of inertia");
  EXPECT_EQ(dimension_name({1, -0.5, -2}), "N/m^1.5");
  EXPECT_EQ(dimension_name({1, 2, -1}), "N*m*s");
  EXPECT_EQ(dimension_name({2, 2, -4}), "N^2");
  EXPECT_EQ(dimension_name({1, -3, 0}), "kg/m^3");
  EXPECT_EQ(dimension_name({-1, 0, 0}), "1/kg");
  EXPECT_EQ(dimension_name({0, 2, -1}), "m^2/s");
  EXPECT_EQ(dimension_name({0, 0, -3}), "1/s^3");
  EXPECT_EQ(si_unit(dimension::damping), "N*s/m");
}

TEST(Dimension, IsEqualUpToRoundOff) {
  EXPECT_EQ(power(dimension::length, 1.0 / 3.0) * power(dimension::length, 2.0 / 3.0), dimension::length);
  EXPECT_FALSE(dimension::length == dimension::mass);
}

}  // namespace
}  // namespace freeplay
