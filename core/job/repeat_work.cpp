#include "job/repeat_work.h"

#include <exception>

#include <fmt/format.h>

#include "base/caught_error.h"
#include "base/error.h"
#include "base/option_value.h"
#include "format/run_override.h"
#include "results/repeat_summary.h"
#include "results/summary.h"
#include "run/play_start.h"
#include "run/simulation.h"

namespace freeplay {
namespace {

constexpr std::size_t most_runs = 10'000;

StudyOutcome failure(int exit_code, const std::string& reason) {
  StudyOutcome outcome;
  outcome.exit_code = exit_code;
  outcome.message = reason;
  return outcome;
}

}  // namespace

StudyOutcome RepeatWork::run(std::uint64_t point, const std::string&) {
  try {
    System system(model_);
    const Start start = assemble_bare_in_play(system, plan_.seed, point + 1);
    const Channels channels(model_);
    Simulation simulation(system, start, channels, {});
    RunHooks hooks;
    hooks.interrupt = stop_;
    const Outcome outcome = simulation.run(hooks);
    if (outcome.exit_code != 0) return failure(outcome.exit_code, outcome.reason);
    const ContactAdvice advice(model_);
    const RunRecord record{
        model_, channels, start.facts, outcome, simulation.statistics(), simulation.clearances(), simulation.last_row(),
        advice, {},       {}};
    StudyOutcome found;
    found.values = RepeatSummary::values_of(summary(record));
    return found;
  } catch (const std::exception& exception) {
    const Error error = error_of(exception);
    return failure(error.exit_code(), fmt::format("{} [{}]", error.message(), error.id()));
  }
}

RepeatPlan repeat_plan(const std::string& repeat, const std::string& seed) {
  RepeatPlan plan;
  if (repeat.empty() && !seed.empty()) {
    throw Error(Error::Category::usage, "usage", "--seed is of the starts of --repeat: give both, or neither");
  }
  if (!seed.empty()) plan.seed = static_cast<std::uint64_t>(whole_number("--seed", seed, 0));
  if (!repeat.empty()) plan.runs = static_cast<std::size_t>(whole_number("--repeat", repeat, 2));
  if (plan.runs <= most_runs) return plan;
  throw Error(Error::Category::usage, "bad-value", fmt::format("--repeat makes at most {} runs", most_runs));
}

void require_repeatable(const Model& model) {
  if (!can_be_repeated(model)) {
    throw Error(
        Error::Category::usage, "nothing-to-repeat",
        "--repeat moves bodies in the play of their joints, or pushes those that touch, and in this model no joint has "
        "play and nothing touches: all runs would be the same");
  }
  if (start_choice(model).repeat != 1) {
    throw Error(Error::Category::usage, "usage",
                fmt::format("--repeat begins with the model's own start, and --set repeat={} asks for another: give "
                            "one of them",
                            start_choice(model).repeat));
  }
}

}  // namespace freeplay
