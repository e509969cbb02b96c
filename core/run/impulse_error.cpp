#include "run/impulse_error.h"

#include <cmath>

#include <fmt/format.h>

#include "run/context.h"

namespace freeplay {

void ImpulseError::say(RunContext& run, const std::string& element) const {
  const double step = std::min(run.settings.step, run.settings.interval), by_impulse = off() / moved();
  const bool by_work = work_counts() && !(by_impulse > std::abs(work_off_) / exchanged_);
  const double part = by_work ? std::abs(work_off_) / exchanged_ : by_impulse;
  const double limit = by_work ? allowed_work : allowed_part;
  const char* const what = by_work ? "work" : "impulse";
  const double percent = 100.0 * std::min(part, 1.0);
  run.warnings.push_back(
      fmt::format("{}: it changes with the motion inside steps of {:.3g} s, which keep the form that it has at their "
                  "begin: they are {:.2g} % off its {}; ask for an accuracy instead, or for steps of {:.2g} s",
                  element, step, percent, what, 0.5 * step * limit / std::min(part, 1.0)));
  run.outcome.doubts.push_back(
      {.id = "unresolved-input",
       .level = Trust::doubtful,
       .message = fmt::format("{} changes with the motion inside steps of {:.3g} s, which are {:.2g} % off its {}",
                              element, step, percent, what),
       .element = element,
       .value = part,
       .limit = limit});
}

}  // namespace freeplay
