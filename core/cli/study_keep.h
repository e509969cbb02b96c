// KeptResults: whole results of a study's points in DIR/kept, beside their rows.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/study_options.h"
#include "study/schedule.h"
#include "workers/worker_pool.h"

namespace freeplay {

/// Each is made by the command of its point. A point whose result is there already is left alone, so that what was cut
/// short goes on, and a study that is done gets them afterwards.
class KeptResults {
 public:
  /// Throws Error{usage} for `--keep` of what has no results, and for very many without --yes. All outlive it.
  KeptResults(const StudyOptions& options, const CommonOptions& common, OpenStudy& study, const StudyFolder& folder);

  using Question = std::function<bool(std::uint64_t point)>;
  /// Of the points of `schedule` that have a row; those that failed alone, if these are to be kept. Ends early where
  /// `interrupts` is not 0. Throws Error{file} "cannot-write".
  void make(const ScheduleOptions& schedule, const Question& has_row, const Question& failed,
            const PoolOptions& pool_options, const std::atomic<int>& interrupts);
  /// A line about what is kept, or nothing.
  std::string message() const;

 private:
  enum class Which { none, failed, all };

  std::filesystem::path place(std::uint64_t point) const;
  bool is_there(std::uint64_t point) const;
  std::vector<std::uint64_t> lacking(const ScheduleOptions& schedule, const Question& has_row, const Question& failed);
  StudyOutcome run(const StudyPoint& point) const;

  const CommonOptions& common_;
  OpenStudy& study_;
  const StudyFolder& folder_;
  Which which_ = Which::none;
  std::uint64_t wanted_ = 0, there_ = 0, fruitless_ = 0;
};

}  // namespace freeplay
