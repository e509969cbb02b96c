// RepeatRuns: the runs of `freeplay run --repeat` beside the one that is written.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "model/model.h"
#include "results/repeat_summary.h"
#include "run/outcome.h"
#include "workers/work.h"
#include "workers/worker_pool.h"

namespace freeplay {

struct RepeatPlan {
  std::size_t runs = 0;  ///< in all, with that of the model's own start; 0: the run is not repeated
  std::uint64_t seed = 1;
};

/// What --repeat and --seed say, empty where they are not given. Throws Error{usage} "bad-value" or "usage".
RepeatPlan repeat_plan(const std::string& repeat, const std::string& seed);

/// A study with one axis, the number of the start in the play: point p is run p + 1. A run gives the figures of its
/// summary.
class RepeatWork final : public StudyWork {
 public:
  /// The model outlives it.
  RepeatWork(const Model& model, const RepeatPlan& plan) : model_(model), plan_(plan) {}

  std::uint64_t points() const override { return plan_.runs - 1; }
  std::uint64_t units() const override { return points(); }
  std::uint64_t unit_size(std::uint64_t) const override { return 1; }
  std::uint64_t unit_point(std::uint64_t unit, std::uint64_t) const override { return unit; }
  UnitPlace place_of(std::uint64_t point) const override { return {point, 0}; }
  bool chained() const override { return false; }
  std::string hash(std::uint64_t) const override { return {}; }
  StudyOutcome run(std::uint64_t point, const std::string& state_before) override;

 private:
  const Model& model_;
  RepeatPlan plan_;
};

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
