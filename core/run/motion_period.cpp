#include "run/motion_period.h"

#include <cmath>

#include "base/formula_period.h"

namespace freeplay {
namespace {

/// Of what a driver prescribes: the speed, or what it is made of. 0: it is constant.
std::optional<double> period_of(const Expression& expression, DriverKind kind, double from, double longest) {
  const auto found = recurrence(expression, from, from + longest);
  const bool of_rate = kind == DriverKind::angle || kind == DriverKind::position;
  if (!found || !(found->period <= longest) || (!of_rate && found->slope != 0.0)) return std::nullopt;
  return found->period;
}

}  // namespace

std::optional<double> motion_period(const Model& model, const Driver& driver, double from, double longest) {
  if (driver.kinematics >= 0) {
    double period = 0.0;
    for (const auto& part : model.kinematics[static_cast<std::size_t>(driver.kinematics)].path.functions) {
      if (!part) continue;
      const auto of_part = period_of(*part, DriverKind::position, from, longest);
      const auto common = of_part ? common_period(period, *of_part) : std::nullopt;
      if (!common) return std::nullopt;
      period = *common;
    }
    return period > 0.0 && period <= longest ? std::optional(period) : std::nullopt;
  }
  if (driver.table) {
    const bool again = driver.table_source.outside == Outside::repeat;
    const auto times = driver.table->times();
    return again ? std::optional(times.back() - times.front()) : std::nullopt;
  }
  if (!driver.by_motion.empty()) return std::nullopt;
  const auto period = period_of(driver.value, driver.kind, from, longest);
  return period && *period == 0.0 ? turn_period(model, driver, from, longest) : period;
}

std::optional<double> load_period(const AppliedForce& force, double from, double longest) {
  if (!force.by_motion.empty()) return std::nullopt;
  double period = 0.0;
  for (const Expression& part : force.value) {
    const auto of_part = part.depends_on_time() ? period_of(part, DriverKind::force, from, longest) : 0.0;
    const auto common = of_part ? common_period(period, *of_part) : std::nullopt;
    if (!common) return std::nullopt;
    period = *common;
  }
  return period > 0.0 && period <= longest ? std::optional(period) : std::nullopt;
}

std::optional<double> turn_period(const Model& model, const Driver& driver, double from, double longest) {
  if (driver.kinematics >= 0 || driver.table || !driver.by_motion.empty()) return std::nullopt;
  const auto period = period_of(driver.value, driver.kind, from, longest);
  if (!period || *period > 0.0) return std::nullopt;
  const bool turns = model.joints[static_cast<std::size_t>(driver.joint)].layout.coordinate == Coordinate::angle;
  Jet jet;
  EvaluationFailure failure;
  if (!driver.value.evaluate(from, jet, failure)) return std::nullopt;
  const double omega = std::abs(driver.kind == DriverKind::angle ? jet.rate : jet.value);
  return turns && prescribes(driver.kind) && omega > 0.0 ? std::optional(2.0 * M_PI / omega) : std::nullopt;
}

}  // namespace freeplay
