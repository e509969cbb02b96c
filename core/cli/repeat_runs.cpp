#include "cli/repeat_runs.h"

#include <algorithm>

#include "cli/interrupt.h"
#include "run/play_start.h"

namespace freeplay {
namespace {

constexpr std::size_t most_workers = 256;

int workers_of(const RepeatPlan& plan, int processes) {
  return static_cast<int>(std::min({static_cast<std::size_t>(processes), plan.runs - 1, most_workers}));
}

}  // namespace

RepeatRuns::RepeatRuns(const Model& model, const RepeatPlan& plan, int processes)
    : plan_(plan),
      work_(model, plan),
      summary_(plan.runs, plan.seed, start_change(model)),
      pool_(work_, {.jobs = workers_of(plan, processes)}) {
  require_repeatable(model);
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
