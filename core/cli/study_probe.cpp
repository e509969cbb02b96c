#include "cli/study_probe.h"

#include <algorithm>
#include <chrono>

#include "cli/interrupt.h"
#include "workers/worker_pool.h"

namespace freeplay {
namespace {
constexpr std::size_t hash_length = 24;  // of a point
}  // namespace

std::optional<PointSeconds> probe_points(OpenStudy& study, std::uint64_t count, double longest) {
  const std::uint64_t points = study.plan().points();
  count = std::min(count, points);
  std::uint64_t given = 0;
  double sum = 0.0, bytes = 0.0;
  std::uint64_t seen = 0;
  PointSeconds seconds{.mean = 0.0, .min = longest, .max = 0.0};
  const auto& interrupts = watch_interrupts();
  const auto begin = std::chrono::steady_clock::now();
  const auto over = [&] {
    return interrupts != 0 || std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > longest;
  };
  WorkerPool pool(study.work(), {.jobs = 1, .isolate = false});
  pool.run(
      [&](StudyTask& task) {
        if (given == count || over()) return false;
        const UnitPlace at = study.plan().place_of(points / count * given++);
        task = {at.unit, at.place, at.place + 1};
        return true;
      },
      [&](std::uint64_t point, const StudyOutcome& outcome) {
        ++seen;
        std::string row;
        append_point(row, point, std::string(hash_length, '0'), outcome, study.layout());
        bytes += static_cast<double>(row.size());
        sum += outcome.cpu;
        seconds.min = std::min(seconds.min, outcome.cpu);
        seconds.max = std::max(seconds.max, outcome.cpu);
      },
      [&] { return !over(); });
  if (seen == 0) return std::nullopt;
  seconds.mean = sum / static_cast<double>(seen);
  seconds.row_bytes = bytes / static_cast<double>(seen);
  return seconds;
}

}  // namespace freeplay
