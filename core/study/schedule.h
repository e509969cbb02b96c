// Schedule: which points of a study are to be run now, as tasks in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/row_scan.h"
#include "study/segment_header.h"
#include "workers/work.h"
#include "workers/worker_pool.h"

namespace freeplay {

/// Ranges of points, both ends included, in order and apart.
using PointRanges = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

/// "0-9,12" as ranges below `points`. Throws Error{usage} "bad-value".
PointRanges point_ranges(const std::string& option, const std::string& text, std::uint64_t points);

/// Is the point in one of them?
bool holds(const PointRanges& ranges, std::uint64_t point);

struct ScheduleOptions {
  Shard shard{};
  std::optional<PointRanges> only{};
  bool retry_failed = false;
};

class Schedule {
 public:
  /// Both outlive it; `scan` may learn of rows meanwhile.
  Schedule(const StudyWork& work, const RowScan& scan, ScheduleOptions options);

  /// The next points of one unit that are to be run, or false. None is given twice.
  bool next(StudyTask& task);
  /// Of the shard.
  std::uint64_t points() const { return points_; }

 private:
  bool named(std::uint64_t point) const;
  bool open(std::uint64_t point) const;
  bool begin_unit();

  const StudyWork& work_;
  const RowScan& scan_;
  ScheduleOptions options_;
  std::uint64_t points_ = 0;
  std::uint64_t unit_ = 0, place_ = 0, unit_end_ = 0;  ///< where it is; up to which place the unit is wanted
  std::uint64_t next_unit_ = 0;
  std::optional<std::vector<std::uint64_t>> units_;  ///< those with points of `only`, where these are few
  std::size_t next_listed_ = 0;
};

}  // namespace freeplay
