// OngoingRun: a run whose rows are kept in memory while it goes on, with files or without.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "python/kept_run.h"
#include "results/contact_advice.h"
#include "results/recording.h"
#include "run/input_course.h"
#include "run/simulation.h"

namespace freeplay {

struct RunRequest {
  std::optional<std::filesystem::path> out;     ///< result directory; without it nothing is written
  std::optional<std::filesystem::path> inputs;  ///< table of them, for run_to_end()
  bool force = false, profile = false;
  std::string call;  ///< how the caller asked, for the record of its making
};

class OngoingRun {
 public:
  /// Called at most ten times a second with the time [s] and the steps so far; where it returns false the step in hand
  /// is the last.
  using Tick = std::function<bool(double, long)>;

  /// The start, assembled. Throws Refusal and Error for what keeps the run from beginning.
  OngoingRun(std::shared_ptr<const OpenedModel> model, const RunRequest& request, Tick tick);
  ~OngoingRun();
  OngoingRun(const OngoingRun&) = delete;

  /// To `goal`. False once the run is over.
  bool advance(const RunGoal& goal);
  /// With the inputs of the request.
  void run_to_end();
  /// Ends it where it is, with its files. Once.
  std::shared_ptr<KeptRun> finish();
  /// From any thread: the step in hand is the last.
  void interrupt() { stop_ = 1; }

  const OpenedModel& model() const { return *opened_; }
  double time() const { return simulation_->time(); }
  long steps() const { return simulation_->steps(); }
  /// Efforts of the inputs, in declaration order, from now on.
  std::vector<double> efforts() const { return simulation_->efforts(); }
  void set_efforts(const std::vector<double>& efforts);
  /// The kept channels now. False once the run is over.
  bool read_row(std::span<double> row);
  /// The same as they were known last.
  void read_last_row(std::span<double> row) const;
  KeptRecord record() const { return rows_->record(); }
  std::size_t columns() const { return rows_->picked().size(); }
  /// False in a process that was forked from the one in which files are written.
  bool at_home() const;

 private:
  void begin();
  void begin_log();
  void note_instant();
  void keep_profile();
  void close(Outcome& outcome);
  void keep_summary(const Outcome& outcome);
  void seal(const Outcome& outcome);

  std::shared_ptr<const OpenedModel> opened_;
  const Model& model_;
  const Channels& channels_;
  RunRequest request_;
  Tick tick_;
  int process_;
  std::shared_ptr<KeptRun> run_;
  Diagnostics diagnostics_;
  std::unique_ptr<AssembledModel> assembled_;
  std::unique_ptr<KeptRows> rows_;
  ContactAdvice advice_{model_};
  std::unique_ptr<Recording> recording_;  // null: no files
  std::vector<Sink*> sinks_;
  std::atomic<int> stop_{0};
  Profile profile_;
  RunHooks hooks_;
  bool has_inputs_;
  InputCourse asked_, course_;  // what is to be set, and what was
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace freeplay
