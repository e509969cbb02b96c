#include "svg/axis.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/unit_prefix.h"

namespace freeplay::svg {
namespace {
constexpr double most_steps = 1e5;     // of the largest value, beyond which labels are differences
constexpr double narrowest = 1e-11;    // range of an axis, of the largest value: less are roundings
constexpr double rounding = 1e-9;      // of a step
constexpr int most_decimals = 12;      // of a label
constexpr double written_out = 1e6;    // numbers without a unit up to here have no exponent,
constexpr double smallest_out = 1e-4;  // and down to here
}  // namespace

double round_step(double least, double most, double count) {
  if (!(most > least) || !std::isfinite(least) || !std::isfinite(most)) return 0.0;
  const double rough = (most - least) / count, power = std::pow(10.0, std::floor(std::log10(rough)));
  const double digit = rough / power < 1.5 ? 1.0 : rough / power < 3.5 ? 2.0 : rough / power < 7.5 ? 5.0 : 10.0;
  return digit * power;
}

std::vector<double> round_numbers(double least, double most, double count) {
  std::vector<double> numbers;
  const double step = round_step(least, most, count);
  if (!(step > 0.0)) return numbers;
  // A step below the rounding of the values themselves never ends.
  const double largest = std::max(std::abs(least), std::abs(most));
  if (!(largest < 1e12 * step)) return numbers;
  const double slack = rounding + 1e-15 * largest / step;
  for (double k = std::ceil(least / step - slack); k <= most / step + slack; ++k) numbers.push_back(k * step + 0.0);
  return numbers;
}

namespace {
/// Labels as differences from the tick in the middle, which the unit names: others would have too many digits.
Axis from_middle(Axis axis, std::string_view unit) {
  const double middle = axis.ticks[axis.ticks.size() / 2];
  const double largest = std::max(std::abs(axis.from - middle), std::abs(axis.until - middle));
  const bool plain = unit.empty() || unit.front() == '1';
  const std::string own = unit == "1" ? "" : std::string(unit);
  const PrefixedUnit to = plain ? PrefixedUnit{1.0, own} : prefixed_unit(largest, unit);
  axis.labels.clear();
  for (const double tick : axis.ticks) axis.labels.push_back(fmt::format("{:.4g}", (tick - middle) / to.factor + 0.0));
  axis.unit =
      fmt::format("{}{}from {:.15g}{}{}", to.unit, to.unit.empty() ? "" : " ", middle, own.empty() ? "" : " ", own);
  return axis;
}
}  // namespace

Axis make_axis(double least, double most, std::string_view unit, double ticks, Fit fit) {
  if (!std::isfinite(least) || !std::isfinite(most)) least = 0.0, most = 1.0;
  const double size = std::max(std::abs(least), std::abs(most));
  if (!(most - least > narrowest * size)) {
    const double around = size > 0.0 ? 0.1 * size : 1.0;
    least -= around, most += around;
  }
  Axis axis{least, most, round_numbers(least, most, ticks), {}, {}};
  if (const double step = round_step(least, most, ticks); fit == Fit::round && !axis.ticks.empty()) {
    axis.from = std::floor(least / step + rounding) * step + 0.0;
    axis.until = std::ceil(most / step - rounding) * step + 0.0;
    axis.ticks = round_numbers(axis.from, axis.until, (axis.until - axis.from) / step);
  }
  const double largest = std::max(std::abs(axis.from), std::abs(axis.until));
  const bool plain = unit.empty() || unit.front() == '1';
  const PrefixedUnit to =
      plain ? PrefixedUnit{1.0, unit == "1" ? "" : std::string(unit)} : prefixed_unit(largest, unit);
  axis.unit = to.unit;
  const double step = round_step(least, most, ticks) / to.factor;
  if (step > 0.0 && largest / to.factor > most_steps * step && !axis.ticks.empty()) return from_middle(axis, unit);
  const bool exponent = largest >= written_out * to.factor || largest < smallest_out * to.factor;
  const int decimals = static_cast<int>(std::clamp(-std::floor(std::log10(step) + rounding), 0.0, 1.0 * most_decimals));
  for (const double tick : axis.ticks) {
    axis.labels.push_back(exponent ? fmt::format("{:g}", tick / to.factor)
                                   : fmt::format("{:.{}f}", tick / to.factor, decimals));
  }
  return axis;
}

}  // namespace freeplay::svg
