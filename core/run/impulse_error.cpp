#include "run/impulse_error.h"

#include <fmt/format.h>

#include "run/context.h"

namespace freeplay {

void ImpulseError::say(RunContext& run, const std::string& element) const {
  const double step = std::min(run.settings.step, run.settings.interval), part = off() / moved();
  const double percent = 100.0 * std::min(part, 1.0);
  run.warnings.push_back(
      fmt::format("{}: it changes with the motion inside steps of {:.3g} s, which keep the form that it has at their "
                  "begin: they are {:.2g} % off its impulse; ask for an accuracy instead, or for steps of {:.2g} s",
                  element, step, percent, 0.5 * step * allowed_part / std::min(part, 1.0)));
  run.outcome.doubts.push_back(
      {.id = "unresolved-input",
       .level = Trust::doubtful,
       .message = fmt::format("{} changes with the motion inside steps of {:.3g} s, which are {:.2g} % off its impulse",
                              element, step, percent),
       .element = element,
       .value = part,
       .limit = allowed_part});
}

}  // namespace freeplay
