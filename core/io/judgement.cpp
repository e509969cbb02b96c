#include "io/judgement.h"

#include <fmt/format.h>

namespace freeplay {
namespace {

/// Impacts that took fewer steps than that say little about their forces.
constexpr double fewest_steps = 10.0;

void judge_steps_per_impact(const RunRecord& record, Verdict& verdict) {
  const ContactAdvice& advice = record.advice;
  if (!(advice.fewest_steps() < fewest_steps)) return;
  verdict.add(
      {.id = "impact-steps",
       .level = Trust::doubtful,
       .message = fmt::format("an impact took {:g} steps, of at least {:g}", advice.fewest_steps(), fewest_steps),
       .value = advice.fewest_steps(),
       .limit = fewest_steps});
}

}  // namespace

void judge(const RunRecord& record, Verdict& verdict) { judge_steps_per_impact(record, verdict); }

}  // namespace freeplay
