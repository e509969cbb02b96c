#include "run/hidden_change.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "model/whole_mass.h"
#include "run/context.h"

namespace freeplay {

namespace {
constexpr double rounding_of_weight = 1e-9;  // of the weight of all bodies, on the earth
constexpr double weight_of_mass = 9.81;      // [m/s^2]
}  // namespace

bool HiddenChange::counts(const RunContext& run) const {
  const std::string_view of = unit;
  const double arm = of == "N m" ? run.system.size() : 1.0;
  const bool is_load = of == "N" || of == "N m";
  const double least = is_load ? rounding_of_weight * weight_of_mass * whole_mass(run.model).mass * arm : 0.0;
  return beyond > std::max(hidden_part * range, least);
}

void HiddenChange::say(RunContext& run, const std::string& element) const {
  const double step = std::min(run.settings.step, run.settings.interval);
  run.warnings.push_back(fmt::format(
      "{}: at t = {:.9g} s, inside a step of {:.3g} s, it goes {:.4g} {} beyond what it is at both ends, and acts "
      "as if it did not; ask for an accuracy instead, or for shorter steps",
      element, at, step, beyond, unit));
  run.outcome.doubts.push_back(
      {.id = "unresolved-input",
       .level = Trust::doubtful,
       .message = fmt::format("{} changes with the motion at t = {:.9g} s in a way that steps of {:.3g} s do not show",
                              element, at, step),
       .element = element,
       .value = beyond,
       .limit = hidden_part * range});
}

}  // namespace freeplay
