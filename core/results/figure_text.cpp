#include "results/figure_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/unit_prefix.h"

namespace freeplay {
namespace {

constexpr double shown_noise = 0.005;  // of the value
constexpr int most_digits = 4, fewest_digits = 3;

/// Power of ten of the first digit; 0 for 0.
int magnitude(double value) {
  const double size = std::abs(value);
  return size > 0.0 && std::isfinite(size) ? static_cast<int>(std::floor(std::log10(size) + 1e-12)) : 0;
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

/// Down to the place 10^-decimals; negative ones round to tens and more.
std::string rounded(double value, int decimals) {
  if (decimals >= 0) return fmt::format("{:.{}f}", value, decimals);
  const double unit = std::pow(10.0, -decimals);
  return fmt::format("{:.0f}", std::round(value / unit) * unit);
}

}  // namespace

bool has_shown_noise(double value, double noise) { return value != 0.0 && std::abs(noise / value) >= shown_noise; }

std::string count_text(long count, bool noisy) {
  if (!noisy || count == 0) return std::to_string(count);
  return "~" + rounded(static_cast<double>(count), std::min(0, 1 - magnitude(static_cast<double>(count))));
}

std::string sum_text(double sum, const char* unit, bool noisy) {
  if (!std::isfinite(sum)) return "-";
  if (!noisy) return figure_text(sum, unit, 0.0, {.digits = 3, .prefixed = true});
  const PrefixedUnit to = prefixed_unit(sum, unit);
  return "~" + with_unit(rounded(sum / to.factor, 1 - magnitude(sum / to.factor)), to.unit);
}

std::string share_text(double part, bool noisy) {
  return fmt::format("{}{:.{}f} %", noisy ? "~" : "", 100.0 * part, noisy ? 0 : 1);
}

std::string figure_text(double value, const char* unit, double noise, FigureStyle style) {
  if (!std::isfinite(value)) return "-";
  const double part = value != 0.0 ? std::abs(noise / value) : 0.0;
  if (!(part >= shown_noise)) {
    int digits = style.digits;
    if (part > 0.0) digits = std::min(digits, std::max(fewest_digits, static_cast<int>(-std::log10(part))));
    const PrefixedUnit to = style.prefixed ? prefixed_unit(value, unit) : PrefixedUnit{1.0, unit};
    return with_unit(fmt::format("{:.{}g}", value / to.factor, digits), to.unit);
  }
  const PrefixedUnit to = prefixed_unit(value, unit);
  const double uncertain = noise / to.factor;
  // One digit of the noise, two where the first is a 1 that rounding would change much.
  int decimals = -magnitude(uncertain);
  if (std::abs(std::stod(rounded(uncertain, decimals)) - uncertain) > 0.25 * uncertain) ++decimals;
  return with_unit(fmt::format("{} +- {}", rounded(value / to.factor, decimals), rounded(uncertain, decimals)),
                   to.unit);
}

std::string range_text(const Json& spread, const char* unit) {
  const Json& median = spread["median"];
  if (!median.is_number()) return "-";
  const double middle = median, low = spread["min"], high = spread["max"];
  const auto runs = std::ranges::count_if(spread["values"], [](const Json& value) { return value.is_number(); });
  const PrefixedUnit to = *unit == '\0' ? PrefixedUnit{1.0, ""} : prefixed_unit(middle, unit);
  const double part = middle != 0.0 ? (high - low) / std::abs(middle) : 0.0;
  const int digits = part < 0.01 ? most_digits : fewest_digits;
  const bool count = *unit == '\0';
  const int decimals = count ? 0 : std::max(0, digits - 1 - magnitude(middle / to.factor));
  const auto number = [&](double value) { return rounded(value / to.factor, decimals); };
  return fmt::format("{} ({} to {} in {} runs)", with_unit(number(middle), to.unit), number(low), number(high), runs);
}

}  // namespace freeplay
