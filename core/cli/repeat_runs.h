// RepeatRuns: the runs of `freeplay run --repeat` beside the one that is written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "model/model.h"
#include "results/repeat_summary.h"
#include "run/simulation.h"

namespace freeplay {

struct RepeatPlan {
  std::size_t runs = 0;  ///< in all, with that of the model's own start; 0: the run is not repeated
  std::uint64_t seed = 1;
};

/// What --repeat and --seed say, empty where they are not given. Throws Error{usage} "bad-value" or "usage".
RepeatPlan repeat_plan(const std::string& repeat, const std::string& seed);

/// Runs 1 to runs - 1 from starts moved inside the play, in processes of their own: a crash costs one run, and plugins
/// with variables of their own cannot disturb each other. What a run finds depends on its number alone.
class RepeatRuns {
 public:
  /// Starts all processes but one: this one is busy with the run that is written. Call it before there are threads.
  /// Throws Error{usage} "nothing-to-repeat" when the model has no play.
  RepeatRuns(const Model& model, const RepeatPlan& plan, int processes);
  /// Ends what still runs.
  ~RepeatRuns();
  RepeatRuns(const RepeatRuns&) = delete;
  RepeatRuns& operator=(const RepeatRuns&) = delete;

  std::size_t runs() const { return plan_.runs; }
  /// Waits for all, also on this process's share of the machine. Returns what they and the first one found, by its
  /// summary and how it ended; once the program is interrupted, what they have found so far. `progress` receives how
  /// many have ended.
  Json finish(const Json& first, const Outcome& outcome, const std::function<void(std::size_t)>& progress);

 private:
  struct Shared;
  struct Worker;
  void start(Worker& worker);
  [[noreturn]] void work(Worker& worker, int parent);
  void reap();
  void take_report(Worker& worker);
  void kill_all();

  const Model& model_;
  RepeatPlan plan_;
  RepeatSummary summary_;
  Shared* shared_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace freeplay
