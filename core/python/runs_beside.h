// RunsBeside: the runs that a run is compared with: by another method, without clearances, from other starts.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "job/repeat_work.h"
#include "job/verify_run.h"
#include "python/run_request.h"
#include "results/row_memory.h"
#include "results/twin_comparison.h"

namespace freeplay {

/// The numbers that a run and its twin have in common, of every row.
class TwinMemory final : public Sink {
 public:
  TwinMemory(const Model& model, const Channels& channels) : numbers_(model, channels) {}
  void row(std::span<const double> values) override;
  void event(const EventRecord&) override {}
  bool ok() const override { return true; }
  std::size_t width() const { return numbers_.size(); }
  const std::vector<double>& numbers() const { return all_; }

 private:
  TwinNumbers numbers_;
  std::vector<double> all_;
};

/// In threads of this process: one with threads must not fork.
class RunsBeside {
 public:
  /// Throws Error{usage} for what the model has no play for, and for options that exclude each other.
  RunsBeside(const OpenedModel& opened, const RunRequest& request);

  /// Where rows of the run go.
  std::vector<Sink*> sinks();
  /// Once the run has ended: its twin, whose files go into `folder`. `outcome` becomes an interrupted one where this
  /// is.
  void run_twin(Outcome& outcome, const RunTick& tick);
  /// Once a run has come to its end by itself. The same.
  void verify(const System& system, Outcome& outcome, const Statistics& statistics, const RunTick& tick);
  /// The other starts of a repeated run: `repeat` of `summary`, and how all ended together.
  void repeat(Outcome& outcome, Json& summary, const RunTick& tick);

  const Json& twin() const { return twin_; }
  const std::optional<Verification>& verification() const { return verification_; }
  /// What the result says besides.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  Json compare(const TwinMemory& other) const;

  const OpenedModel& opened_;
  const RunRequest& request_;
  RepeatPlan plan_;
  std::optional<RowMemory> rows_;
  std::optional<TwinMemory> twin_rows_;
  Json twin_ = nullptr;
  std::optional<Verification> verification_;
  std::vector<std::string> warnings_;
};

}  // namespace freeplay
