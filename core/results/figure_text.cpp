#include "results/figure_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/unit_prefix.h"

namespace freeplay {
namespace {

constexpr double shown_noise = 0.005;  // of the value
constexpr double shown_of_count = 0.5, shown_of_share = 5e-4;
constexpr int most_digits = 4, fewest_digits = 3;
constexpr int most_decimals = 9;  // beyond which a power of ten is shorter

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

/// One digit of the noise, two where the first is a 1 that rounding would change much.
std::string with_noise(double value, double noise) {
  int decimals = -magnitude(noise);
  if (decimals > most_decimals) return fmt::format("{:.0e} +- {:.0e}", value, noise);
  if (std::abs(std::stod(rounded(noise, decimals)) - noise) > 0.25 * noise) ++decimals;
  return fmt::format("{} +- {}", rounded(value, decimals), rounded(noise, decimals));
}

}  // namespace

std::string count_text(long count, double noise) {
  return noise < shown_of_count ? std::to_string(count) : with_noise(static_cast<double>(count), noise);
}

std::string share_text(double part, double noise) {
  if (noise < shown_of_share) return fmt::format("{:.1f} %", 100.0 * std::max(part, 0.0));
  return with_noise(100.0 * part, 100.0 * noise) + " %";
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
  return with_unit(with_noise(value / to.factor, noise / to.factor), to.unit);
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
  const auto number = [&](double value) {
    return decimals > most_decimals ? fmt::format("{:.{}g}", value / to.factor, digits)
                                    : rounded(value / to.factor, decimals);
  };
  return fmt::format("{} ({} to {} in {} runs)", with_unit(number(middle), to.unit), number(low), number(high), runs);
}

}  // namespace freeplay
