// Unit: the unit names of the model file, their factors to SI and their dimensions.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace freeplay {

/// Exponents of kilogram, metre and second. An angle is dimensionless. Equal means equal to 1e-9, so that exponents
/// which were computed, such as 3 * (1.0 / 3), compare as a person expects.
struct Dimension {
  double kg = 0.0, m = 0.0, s = 0.0;

  bool dimensionless() const { return *this == Dimension{}; }

  friend bool operator==(const Dimension& a, const Dimension& b) {
    const auto same = [](double x, double y) { return std::abs(x - y) <= 1e-9; };
    return same(a.kg, b.kg) && same(a.m, b.m) && same(a.s, b.s);
  }
  friend constexpr Dimension operator*(const Dimension& a, const Dimension& b) {
    return {a.kg + b.kg, a.m + b.m, a.s + b.s};
  }
  friend constexpr Dimension operator/(const Dimension& a, const Dimension& b) {
    return {a.kg - b.kg, a.m - b.m, a.s - b.s};
  }
  friend constexpr Dimension power(const Dimension& a, double n) { return {a.kg * n, a.m * n, a.s * n}; }
};

/// The dimensions that fields of a model have.
namespace dimension {
inline constexpr Dimension none{}, angle{}, mass{1, 0, 0}, length{0, 1, 0}, time{0, 0, 1}, velocity{0, 1, -1},
    acceleration{0, 1, -2}, angular_velocity{0, 0, -1}, angular_acceleration{0, 0, -2}, force{1, 1, -2},
    torque{1, 2, -2}, moment_of_inertia{1, 2, 0}, pressure{1, -1, -2}, energy{1, 2, -2}, power{1, 2, -3},
    stiffness{1, 0, -2}, damping{1, 0, -1}, area{0, 2, 0};
}  // namespace dimension

/// For messages: "length", "mass", "torque or energy", "angle or number", else a product such as "N/m^1.5".
std::string dimension_name(const Dimension& dimension);

/// An SI unit of the dimension, for messages: "m", "kg*m^2", "rad/s"; "1" when dimensionless.
std::string si_unit(const Dimension& dimension);

/// Value in SI = value in the unit * factor.
struct Unit {
  double factor = 1.0;
  Dimension dimension;
};

/// Value of a name that stands as an exponent or chooses among units, or nothing when it has none.
using ExponentLookup = std::function<std::optional<double>(std::string_view name)>;

/// Reads a whole unit such as "kg*m^2", "N/m^1.5", "rad/s"; "1" is dimensionless and may begin a quotient ("1/s").
/// With `exponents`, an exponent may be a name, as in "N/m^exponent"; "NAME: UNIT | UNIT" is the unit at the index that
/// NAME has as its value, the first when it has none.
/// Throws ExpressionError `bad-unit`.
Unit parse_unit(std::string_view text, const ExponentLookup& exponents = {});

/// Reads the unit that begins at byte `position` of an expression and moves `position` past it. A `*` or `/`
/// continues the unit only if a unit name follows it. Throws ExpressionError `bad-unit`, with a place in `text`.
Unit parse_unit_at(std::string_view text, std::size_t& position);

/// True if `word` is one of the unit names.
bool is_unit_name(std::string_view word);
/// What to write in place of a unit that is in use elsewhere, as "write '100 kPa' for each 'bar'"; empty for other
/// words.
std::string hint_for_foreign_unit(std::string_view word);

/// All unit names, in the order of the manual.
std::vector<std::string> unit_names();

}  // namespace freeplay
