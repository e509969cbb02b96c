// Engine: runs what is open of a study and writes its rows.
#pragma once

#include <cstdint>
#include <functional>

#include "study/row_scan.h"
#include "study/row_text.h"
#include "study/schedule.h"
#include "study/segment_writer.h"
#include "study/stop_rule.h"
#include "workers/work.h"
#include "workers/worker_pool.h"

namespace freeplay {

struct EngineReport {
  std::uint64_t ran = 0, workers_lost = 0;
  double busy_seconds = 0.0;  ///< of all workers together
};

/// Gives the values of a study's samples to the rule by which it may end early; `rule` is null where there is none.
struct StopWatch {
  StopRule* rule = nullptr;
  std::uint64_t samples = 1;  ///< of each combination
  std::size_t column = 0;     ///< of the reducer it looks at

  void note(std::uint64_t point, double value) const;
};

/// Runs the points of `schedule`; each is in the segment, and in `scan`, before its worker gets more. Ends where
/// `beat` returns false, which is called at least every 0.1 s. Throws Error{file} where a row cannot be written.
EngineReport run_points(StudyWork& work, const RowLayout& layout, Schedule& schedule, RowScan& scan,
                        SegmentWriter& segment, const PoolOptions& options, const StopWatch& stop,
                        const std::function<bool(const EngineReport&)>& beat);

}  // namespace freeplay
