#include "cli/repeat_runs.h"

#include <algorithm>
#include <exception>

#include <fmt/format.h>

#include "base/caught_error.h"
#include "base/error.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "format/run_override.h"
#include "results/summary.h"
#include "run/play_start.h"
#include "run/simulation.h"

namespace freeplay {
namespace {

constexpr std::size_t most_workers = 256, most_runs = 10'000;

int workers_of(const RepeatPlan& plan, int processes) {
  return static_cast<int>(std::min({static_cast<std::size_t>(processes), plan.runs - 1, most_workers}));
}

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
    const Start start = assemble_in_play(system, plan_.seed, point + 1);
    const Channels channels(model_);
    Simulation simulation(system, start, channels, {});
    const Outcome outcome = simulation.run({});
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

RepeatRuns::RepeatRuns(const Model& model, const RepeatPlan& plan, int processes)
    : plan_(plan),
      work_(model, plan),
      summary_(plan.runs, plan.seed, moved_in_play),
      pool_(work_, {.jobs = workers_of(plan, processes)}) {
  if (model.clearance_joints() == 0) {
    throw Error(
        Error::Category::usage, "nothing-to-repeat",
        "--repeat moves bodies in the play of their joints, and no joint of this model has play: all runs would "
        "be the same");
  }
  if (start_choice(model).repeat != 1) {
    throw Error(Error::Category::usage, "usage",
                fmt::format("--repeat begins with the model's own start, and --set repeat={} asks for another: give "
                            "one of them",
                            start_choice(model).repeat));
  }
  pool_.start(static_cast<std::size_t>(processes - 1));
  looked_ = {};
  look_after();
}

bool RepeatRuns::next(StudyTask& task) {
  if (given_ == work_.points()) return false;
  task = {.unit = given_, .first = 0, .end = 1};
  ++given_;
  return true;
}

void RepeatRuns::take(std::uint64_t point, const StudyOutcome& outcome) {
  ++ended_;
  if (outcome.exit_code != 0) return summary_.fail(point + 1, outcome.exit_code, outcome.message);
  summary_.add(point + 1, outcome.values);
}

void RepeatRuns::look_after() {
  constexpr std::chrono::milliseconds seldom{2};
  const auto now = std::chrono::steady_clock::now();
  if (now - looked_ < seldom) return;
  looked_ = now;
  pool_.turn([this](StudyTask& task) { return next(task); },
             [this](std::uint64_t point, const StudyOutcome& outcome) { take(point, outcome); });
}

Json RepeatRuns::finish(const Json& first, const Outcome& outcome, const std::function<void(std::size_t)>& progress) {
  const std::atomic<int>& interrupts = watch_interrupts();
  pool_.run([this](StudyTask& task) { return next(task); },
            [this](std::uint64_t point, const StudyOutcome& of) { take(point, of); },
            [&] {
              progress(ended_);
              return interrupts == 0;
            });
  if (outcome.status == RunStatus::completed || outcome.status == RunStatus::stopped)
    summary_.add(0, RepeatSummary::values_of(first));
  if (outcome.status == RunStatus::failed) summary_.fail(0, outcome.exit_code, outcome.reason);
  return summary_.json(first);
}

}  // namespace freeplay
