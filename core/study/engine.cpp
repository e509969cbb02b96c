#include "study/engine.h"

#include <limits>
#include <string>

namespace freeplay {

void StopWatch::note(std::uint64_t point, double value) const {
  if (rule != nullptr) rule->note(point / samples, point % samples, value);
}

EngineReport run_points(StudyWork& work, const RowLayout& layout, Schedule& schedule, RowScan& scan,
                        SegmentWriter& segment, const PoolOptions& options, const StopWatch& stop,
                        const std::function<bool(const EngineReport&)>& beat) {
  EngineReport report;
  WorkerPool pool(work, options);
  std::string lines;
  const auto stopped = [&] { return stop.rule != nullptr && stop.rule->end().has_value(); };
  const auto next = [&](StudyTask& task) { return !stopped() && schedule.next(task); };
  const auto take = [&](std::uint64_t point, const StudyOutcome& outcome) {
    lines.clear();
    append_point(lines, point, work.hash(point), outcome, layout, scan.running_origin(point));
    segment.put(lines);
    scan.note(point, outcome);
    const bool good = outcome.exit_code == 0 && stop.column < outcome.values.size();
    stop.note(point, good ? outcome.values[stop.column] : std::numeric_limits<double>::quiet_NaN());
    ++report.ran;
    report.busy_seconds += outcome.wall;
  };
  pool.run(next, take, [&] {
    segment.sync_if_due();
    report.workers_lost = pool.lost();
    return !stopped() && beat(report);
  });
  report.workers_lost = pool.lost();
  segment.close();
  return report;
}

}  // namespace freeplay
