#include "run/motion_period.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace freeplay {
namespace {

constexpr int instants = 4096;     // at which a formula is looked at
constexpr double sameness = 1e-6;  // of values a period apart, by the largest

using Function = std::function<double(double)>;  // NaN where it has no value

Function rate_of(const Expression& expression, DriverKind kind) {
  return [&expression, kind](double t) {
    Jet jet{};
    EvaluationFailure failure;
    if (!expression.evaluate(t, jet, failure)) return std::nan("");
    return kind == DriverKind::angle || kind == DriverKind::position ? jet.rate : jet.value;
  };
}

/// Whether f(t + period) = f(t) at many instants from `from` on.
bool repeats(const Function& f, double from, double period, double size) {
  for (int i = 0; i <= 64; ++i) {
    const double t = from + period * i / 64.0;
    if (!(std::abs(f(t + period) - f(t)) <= sameness * size)) return false;
  }
  return true;
}

/// Crossings of f through the value in the middle of its range come again with the period.
std::optional<double> period_of(const Function& f, double from, double longest) {
  std::vector<double> values;
  double least = unbounded, most = -unbounded;
  for (int i = 0; i <= instants; ++i) {
    values.push_back(f(from + longest * i / instants));
    if (!std::isfinite(values.back())) return std::nullopt;
    least = std::min(least, values.back()), most = std::max(most, values.back());
  }
  const double size = std::max(std::abs(least), std::abs(most)), middle = 0.5 * (least + most);
  if (most - least <= sameness * size) return 0.0;  // it is constant
  std::vector<double> rising;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!(values[i - 1] < middle && values[i] >= middle)) continue;
    double low = from + longest * static_cast<double>(i - 1) / instants, high = low + longest / instants;
    for (int k = 0; k < 60; ++k) (f(0.5 * (low + high)) < middle ? low : high) = 0.5 * (low + high);
    rising.push_back(high);
    const double period = high - rising.front();
    if (rising.size() > 1 && repeats(f, rising.front(), period, size)) return period;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> motion_period(const Model& model, const Driver& driver, double from, double longest) {
  if (driver.kinematics >= 0) {
    double period = 0.0;
    for (const auto& part : model.kinematics[static_cast<std::size_t>(driver.kinematics)].path) {
      if (!part) continue;
      const auto found = period_of(rate_of(*part, DriverKind::position), from, longest);
      if (!found) return std::nullopt;
      period = std::max(period, *found);
    }
    return period > 0.0 ? std::optional(period) : std::nullopt;
  }
  if (driver.table) {
    const bool again = driver.table_source.outside == Outside::repeat;
    const auto times = driver.table->times();
    return again ? std::optional(times.back() - times.front()) : std::nullopt;
  }
  const Function rate = rate_of(driver.value, driver.kind);
  const auto period = period_of(rate, from, longest);
  if (!period || *period > 0.0) return period;
  const bool turns = model.joints[static_cast<std::size_t>(driver.joint)].layout.coordinate == Coordinate::angle;
  const double omega = std::abs(rate(from));
  return turns && prescribes(driver.kind) && omega > 0.0 ? std::optional(2.0 * M_PI / omega) : std::nullopt;
}

}  // namespace freeplay
