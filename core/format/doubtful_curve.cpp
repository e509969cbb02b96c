#include "format/doubtful_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace freeplay {
namespace {

constexpr int places_of_round = 3600;  // a tenth of a degree apart
constexpr double one_value = 1e-12;    // of the largest: rounding
constexpr double no_cam = 20.0;        // largest radius by the smallest

struct RoundValues {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  bool known = true;
  bool is_one() const { return most - least <= one_value * std::max(std::abs(least), std::abs(most)); }
};

/// `turn`: what the formula takes for a whole one.
RoundValues values_around(const Expression& formula, double turn) {
  RoundValues out;
  for (int i = 0; i < places_of_round; ++i) {
    const double angle[] = {turn * i / places_of_round}, value = formula.value(0.0, angle);
    out.known = out.known && std::isfinite(value);
    out.least = std::min(out.least, value), out.most = std::max(out.most, value);
  }
  return out;
}

}  // namespace

void doubt_curve(const Expression& formula, const TableVariables& variables, const Dimension& of_value,
                 const CheckedValue& written) {
  const std::vector<std::string> names = variables.names();
  if (names.size() != 1 || !formula.depends_on_variables() || !(of_value == dimension::length)) return;
  if (!(variables.find(names[0])->dimension == dimension::angle)) return;
  const RoundValues radians = values_around(formula, 2.0 * std::numbers::pi), degrees = values_around(formula, 360.0);
  if (radians.known && radians.least > 0.0 && radians.most > no_cam * radians.least) {
    written.warn("doubtful-length",
                 fmt::format("'{}' goes from {:.4g} m to {:.4g} m, as no cam does: check its lengths and their units",
                             written.path(), radians.least, radians.most));
    return;
  }
  // A circle that a parameter makes of another curve is one in degrees, too.
  if (!radians.known || !radians.is_one() || !degrees.known || degrees.is_one()) return;
  written.warn(
      "doubtful-angle",
      fmt::format("'{}' is {:.4g} m all the way round, though it changes with '{}', which is in radians: write "
                  "the unit after its angles, as in '60 deg'",
                  written.path(), radians.most, names[0]));
}

}  // namespace freeplay
