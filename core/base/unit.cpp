#include "base/unit.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/expression_error.h"
#include "base/suggestion.h"
#include "base/text.h"
#include "base/token.h"

namespace freeplay {
namespace {

constexpr double pi = 3.14159265358979323846;

struct NamedUnit {
  std::string_view name;
  double factor;
  Dimension dimension;
};

// Section 1.5 of the model format: exactly these. Factors of inch, foot and pound by the international agreement of
// 1959; pound-force with the standard acceleration of free fall.
constexpr NamedUnit units[] = {
    {"m", 1.0, dimension::length},
    {"km", 1e3, dimension::length},
    {"cm", 1e-2, dimension::length},
    {"mm", 1e-3, dimension::length},
    {"um", 1e-6, dimension::length},
    {"\u00b5m", 1e-6, dimension::length},
    {"nm", 1e-9, dimension::length},
    {"in", 0.0254, dimension::length},
    {"ft", 0.3048, dimension::length},
    {"kg", 1.0, dimension::mass},
    {"g", 1e-3, dimension::mass},
    {"mg", 1e-6, dimension::mass},
    {"lb", 0.45359237, dimension::mass},
    {"s", 1.0, dimension::time},
    {"ms", 1e-3, dimension::time},
    {"us", 1e-6, dimension::time},
    {"\u00b5s", 1e-6, dimension::time},
    {"ns", 1e-9, dimension::time},
    {"rad", 1.0, dimension::angle},
    {"mrad", 1e-3, dimension::angle},
    {"urad", 1e-6, dimension::angle},
    {"deg", pi / 180.0, dimension::angle},
    {"arcmin", pi / 10800.0, dimension::angle},
    {"arcsec", pi / 648000.0, dimension::angle},
    {"rev", 2.0 * pi, dimension::angle},
    {"rpm", pi / 30.0, dimension::angular_velocity},
    {"N", 1.0, dimension::force},
    {"mN", 1e-3, dimension::force},
    {"kN", 1e3, dimension::force},
    {"MN", 1e6, dimension::force},
    {"lbf", 4.4482216152605, dimension::force},
    {"Nm", 1.0, dimension::torque},
    {"Nmm", 1e-3, dimension::torque},
    {"mNm", 1e-3, dimension::torque},
    {"kNm", 1e3, dimension::torque},
    {"Pa", 1.0, dimension::pressure},
    {"kPa", 1e3, dimension::pressure},
    {"MPa", 1e6, dimension::pressure},
    {"GPa", 1e9, dimension::pressure},
    {"J", 1.0, dimension::energy},
    {"mJ", 1e-3, dimension::energy},
    {"kJ", 1e3, dimension::energy},
    {"W", 1.0, dimension::power},
    {"mW", 1e-3, dimension::power},
    {"kW", 1e3, dimension::power},
};

struct ForeignUnit {
  std::string_view name, amount;
};

// Conversions by NIST Special Publication 811, appendix B.
constexpr ForeignUnit foreign_units[] = {
    {"bar", "100 kPa"},   {"mbar", "100 Pa"},  {"atm", "101325 Pa"}, {"psi", "6894.757 Pa"}, {"daN", "10 N"},
    {"kgf", "9.80665 N"}, {"kp", "9.80665 N"}, {"hp", "745.6999 W"}, {"PS", "735.4988 W"},   {"MW", "1000 kW"},
    {"min", "60 s"},      {"h", "3600 s"},     {"cal", "4.1868 J"},  {"oz", "28.34952 g"},
};

struct NamedDimension {
  Dimension dimension;
  const char* name;
  const char* si;
};

constexpr NamedDimension named_dimensions[] = {
    {dimension::none, "angle or number", "1"},
    {dimension::length, "length", "m"},
    {dimension::mass, "mass", "kg"},
    {dimension::time, "time", "s"},
    {dimension::velocity, "velocity", "m/s"},
    {dimension::acceleration, "acceleration", "m/s^2"},
    {dimension::angular_velocity, "angular velocity", "rad/s"},
    {dimension::angular_acceleration, "angular acceleration", "rad/s^2"},
    {dimension::force, "force", "N"},
    {dimension::torque, "torque or energy", "N*m"},
    {dimension::moment_of_inertia, "moment of inertia", "kg*m^2"},
    {dimension::pressure, "pressure", "Pa"},
    {dimension::power, "power", "W"},
    {dimension::stiffness, "stiffness", "N/m"},
    {dimension::damping, "damping", "N*s/m"},
    {dimension::area, "area", "m^2"},
};

const NamedUnit* find_unit(std::string_view name) {
  const auto found = std::find_if(std::begin(units), std::end(units), [&](const auto& u) { return u.name == name; });
  return found == std::end(units) ? nullptr : found;
}

const NamedDimension* find_dimension(const Dimension& dimension) {
  const auto found = std::find_if(std::begin(named_dimensions), std::end(named_dimensions),
                                  [&](const auto& d) { return d.dimension == dimension; });
  return found == std::end(named_dimensions) ? nullptr : found;
}

struct Power {
  const char* symbol;
  double exponent;
};

/// "kg*m^2/s"
std::string product(std::initializer_list<Power> powers) {
  std::string above, below;
  for (const auto& [symbol, exponent] : powers) {
    if (std::abs(exponent) <= 1e-9) continue;
    std::string& side = exponent > 0 ? above : below;
    side += exponent > 0 ? (side.empty() ? "" : "*") : "/";
    side += symbol;
    const double size = std::abs(exponent);
    if (std::abs(size - 1.0) > 1e-9) side += fmt::format("^{:.6g}", size);
  }
  return (above.empty() ? "1" : above) + below;
}

/// As people write it: with newtons where that is shorter, "N/m^1.5" and not "kg/m^0.5/s^2".
std::string product(const Dimension& d) {
  const Dimension rest = d / power(dimension::force, d.kg);
  std::string base = product({{"kg", d.kg}, {"m", d.m}, {"s", d.s}});
  std::string newtons = product({{"N", d.kg}, {"m", rest.m}, {"s", rest.s}});
  return newtons.size() < base.size() ? newtons : base;
}

/// Reads a unit from a text that may be longer.
class UnitReader {
 public:
  UnitReader(std::string_view text, std::size_t position, const ExponentLookup& exponents)
      : text_(text), position_(position), exponents_(exponents) {}

  /// With `whole`, the unit is not part of an expression: "1" may begin it, and it must end with the text.
  Unit read(bool whole) {
    Unit unit;
    const std::size_t begin = skip_blanks(text_, position_);
    if (whole && begin < text_.size() && text_[begin] == '1') {
      position_ = begin + 1;
    } else {
      unit = factor(unit, '*');
    }
    for (char sign = continuation(); sign != '\0'; sign = continuation()) {
      position_ = skip_blanks(text_, position_) + 1;
      unit = factor(unit, sign);
    }
    if (whole) require_end();
    return unit;
  }

  std::size_t position() const { return position_; }

 private:
  [[noreturn]] void fail(std::size_t begin, std::size_t end, std::string message, std::string nearest = {},
                         std::string hint = {}) const {
    throw ExpressionError("bad-unit", std::move(message), character_count(text_.substr(0, begin)),
                          std::max(1, character_count(text_.substr(begin, end - begin))), std::move(nearest),
                          std::move(hint));
  }

  void require_end() {
    position_ = skip_blanks(text_, position_);
    if (position_ == text_.size()) return;
    const bool sign = text_[position_] == '*' || text_[position_] == '/';
    const std::size_t begin = skip_blanks(text_, position_ + (sign ? 1 : 0));
    position_ = word_end(text_, begin);
    if (position_ > begin) refuse(text_.substr(begin, position_ - begin), begin);
    fail(begin, text_.size(), "this is not part of a unit");
  }

  /// The `*` or `/` that continues the unit, or 0.
  char continuation() const {
    const std::size_t at = skip_blanks(text_, position_);
    if (at >= text_.size() || (text_[at] != '*' && text_[at] != '/')) return '\0';
    const std::size_t begin = skip_blanks(text_, at + 1);
    const std::string_view word = text_.substr(begin, word_end(text_, begin) - begin);
    return is_unit_name(word) || word == "Hz" ? text_[at] : '\0';
  }

  Unit factor(const Unit& unit, char sign) {
    const std::size_t begin = skip_blanks(text_, position_);
    position_ = word_end(text_, begin);
    const std::string_view name = text_.substr(begin, position_ - begin);
    if (name.empty()) fail(begin, begin + 1, "a unit name is missing");
    const NamedUnit* named = find_unit(name);
    if (!named) refuse(name, begin);
    const double n = exponent();
    const double scale = std::pow(named->factor, n);
    const Dimension dimension = power(named->dimension, n);
    const Unit result = sign == '*' ? Unit{unit.factor * scale, unit.dimension * dimension}
                                    : Unit{unit.factor / scale, unit.dimension / dimension};
    const Dimension& d = result.dimension;
    if (!std::isfinite(result.factor) || result.factor == 0.0 || !std::isfinite(d.kg + d.m + d.s)) {
      fail(begin, position_, fmt::format("the exponent of '{}' is too large", name));
    }
    return result;
  }

  [[noreturn]] void refuse(std::string_view name, std::size_t begin) const {
    if (std::string hint = hint_for_foreign_unit(name); !hint.empty())
      fail(begin, position_, fmt::format("'{}' is not a unit", name), {}, std::move(hint));
    if (name == "\u00b0") fail(begin, position_, fmt::format("'{}' is not a unit", name), "deg");
    fail(begin, position_, fmt::format("'{}' is not a unit", name), suggestion(name, unit_names()).value_or(""));
  }

  double exponent() {
    std::size_t at = skip_blanks(text_, position_);
    if (at >= text_.size() || text_[at] != '^') return 1.0;
    at = skip_blanks(text_, at + 1);
    const std::size_t begin = at;
    const bool negative = at < text_.size() && text_[at] == '-';
    if (negative) at = skip_blanks(text_, at + 1);
    double value = 0.0;
    if (const std::size_t end = number_end(text_, at); end > at) {
      value = number_value(text_.substr(at, end - at));
      position_ = end;
    } else {
      value = named_exponent(at);
    }
    if (!std::isfinite(value)) fail(begin, position_, "the exponent of the unit is not finite");
    return negative ? -value : value;
  }

  double named_exponent(std::size_t at) {
    std::size_t end = word_end(text_, at);
    // A name may be a path: "law.exponent".
    while (exponents_ && end < text_.size() && text_[end] == '.' && word_end(text_, end + 1) > end + 1) {
      end = word_end(text_, end + 1);
    }
    const auto value = exponents_ ? exponents_(text_.substr(at, end - at)) : std::nullopt;
    if (!value) fail(at, std::max(end, at + 1), "the exponent of a unit must be a number");
    position_ = end;
    return *value;
  }

  std::string_view text_;
  std::size_t position_;
  const ExponentLookup& exponents_;
};

}  // namespace

std::string dimension_name(const Dimension& dimension) {
  const NamedDimension* named = find_dimension(dimension);
  return named ? named->name : product(dimension);
}

std::string si_unit(const Dimension& dimension) {
  const NamedDimension* named = find_dimension(dimension);
  return named ? named->si : product(dimension);
}

Unit parse_unit(std::string_view text, const ExponentLookup& exponents) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || !exponents) return UnitReader(text, 0, exponents).read(true);
  const std::optional<double> index = exponents(text.substr(0, colon));
  std::string_view rest = text.substr(colon + 1);
  for (double i = 0.0; i < index.value_or(0.0) && rest.find('|') != std::string_view::npos; ++i) {
    rest.remove_prefix(rest.find('|') + 1);
  }
  return UnitReader(rest.substr(0, rest.find('|')), 0, exponents).read(true);
}

Unit parse_unit_at(std::string_view text, std::size_t& position) {
  const ExponentLookup none;
  UnitReader reader(text, position, none);
  const Unit unit = reader.read(false);
  position = reader.position();
  return unit;
}

bool is_unit_name(std::string_view word) { return find_unit(word) != nullptr; }

std::string hint_for_foreign_unit(std::string_view word) {
  if (word == "Hz") return "write 'rev/s' or 'rad/s'";
  const auto* unit = std::ranges::find(foreign_units, word, &ForeignUnit::name);
  return unit == std::end(foreign_units) ? std::string()
                                         : fmt::format("write '{}' for each '{}'", unit->amount, unit->name);
}

std::vector<std::string> unit_names() {
  std::vector<std::string> names;
  for (const NamedUnit& unit : units) names.emplace_back(unit.name);
  return names;
}

}  // namespace freeplay
