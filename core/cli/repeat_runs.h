// RepeatRuns: the runs of `freeplay run --repeat` beside the one that is written.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "job/repeat_work.h"
#include "results/repeat_summary.h"
#include "run/outcome.h"
#include "workers/worker_pool.h"

namespace freeplay {

/// Runs 1 to runs - 1 from starts moved inside the play, by the workers of a study: a crash costs one run, and plugins
/// with variables of their own cannot disturb each other. What a run finds depends on its number alone.
class RepeatRuns {
 public:
  /// Starts all workers but one: this process is busy with the run that is written. Call it before there are threads.
  /// Throws Error{usage} "nothing-to-repeat" when the model has no play.
  RepeatRuns(const Model& model, const RepeatPlan& plan, int processes);

  std::size_t runs() const { return plan_.runs; }
  /// Gives the workers more to do. To be called often while the run that is written goes on.
  void look_after();
  /// Waits for all, also on this process's share of the machine. Returns what they and the first one found, by its
  /// summary and how it ended; once the program is interrupted, what they have found so far. `progress` receives how
  /// many have ended.
  Json finish(const Json& first, const Outcome& outcome, const std::function<void(std::size_t)>& progress);

 private:
  bool next(StudyTask& task);
  void take(std::uint64_t point, const StudyOutcome& outcome);

  RepeatPlan plan_;
  RepeatWork work_;
  RepeatSummary summary_;
  WorkerPool pool_;
  std::uint64_t given_ = 0, ended_ = 0;
  std::chrono::steady_clock::time_point looked_{};
};

}  // namespace freeplay
