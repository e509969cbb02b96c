#include "run/hidden_change.h"

#include <algorithm>

#include <fmt/format.h>

#include "run/context.h"

namespace freeplay {

bool HiddenChange::counts() const { return beyond > hidden_part * range; }

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
