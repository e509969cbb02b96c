// OngoingRun: a run whose rows are kept in memory while it goes on, with files or without.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "python/file_sinks.h"
#include "python/kept_run.h"
#include "python/run_request.h"
#include "python/runs_beside.h"
#include "results/checkpoints.h"
#include "results/contact_advice.h"
#include "results/recording.h"
#include "run/input_course.h"
#include "run/simulation.h"

namespace freeplay {

class OngoingRun {
 public:
  /// The start, assembled. Throws Refusal and Error for what keeps the run from beginning.
  OngoingRun(std::shared_ptr<const OpenedModel> model, const RunRequest& request, RunTick tick);
  ~OngoingRun();
  OngoingRun(const OngoingRun&) = delete;

  /// To `goal`. False once the run is over.
  bool advance(const RunGoal& goal);
  /// With the inputs of the request, or of the run that goes on.
  void run_to_end();
  /// Ends it where it is, with its files. Once.
  std::shared_ptr<KeptRun> finish();
  /// From any thread: the step in hand is the last.
  void interrupt() { asked_ = 1; }

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
  /// What another run of the same model goes on from, with all rows up to here: RunRequest::state.
  std::string checkpoint() const;
  std::size_t columns() const { return rows_->picked().size(); }
  /// In a process that was forked from the one that began it: from now on without the files, which that one writes.
  void leave_files_of_others();

 private:
  void begin();
  void begin_recording(const Making& making);
  void begin_simulation();
  void read_state();
  void restore();
  void begin_log();
  void look_up();
  const Checkpoint* from() const;
  std::vector<std::string> warnings() const;
  void note_instant();
  void keep_profile();
  void add_asked(Json& record);
  void keep_course();
  void close(Outcome& outcome);
  void keep_summary(const Outcome& outcome);
  void seal(const Outcome& outcome);

  std::shared_ptr<const OpenedModel> opened_;
  const Model& model_;
  const Channels& channels_;
  RunRequest request_;
  std::optional<Checkpoint> state_;  // of the request
  RunTick tick_;
  int process_;
  std::shared_ptr<KeptRun> run_;
  Diagnostics diagnostics_;
  std::unique_ptr<AssembledModel> assembled_;
  std::unique_ptr<KeptRows> rows_;
  ContactAdvice advice_{model_};
  std::unique_ptr<Recording> recording_;  // null: no files
  FileSinks files_;
  std::vector<Sink*> sinks_;
  std::optional<Checkpoints> checkpoints_;  // of a run with files that the command line could go on with
  std::atomic<int> asked_{0}, stop_{0};     // to end: by the caller, and after a last checkpoint
  Profile profile_;
  RunHooks hooks_;
  bool has_inputs_;
  InputCourse given_, course_;  // what is to be set, and what was
  std::unique_ptr<RunsBeside> beside_;
  Json provenance_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace freeplay
