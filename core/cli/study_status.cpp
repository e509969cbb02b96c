#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "cli/interrupt.h"
#include "cli/progress_line.h"
#include "cli/study_table.h"
#include "cli/study_views.h"
#include "cli/terminal.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

/// Segments that rows were written to in the last two minutes, and their rows per second together.
struct Activity {
  int active = 0;
  double per_second = 0.0;
};

Activity activity_of(const StudyFolder& folder, const RowLayout& layout) {
  constexpr std::chrono::minutes lately{2};
  Activity activity;
  const auto now = fs::file_time_type::clock::now();
  for (const fs::path& segment : folder.segments()) {
    std::error_code error;
    const auto written = fs::last_write_time(segment, error);
    if (error || now - written > lately) continue;
    ++activity.active;
    SegmentReader reader(segment, [](const fs::path&, std::size_t) {});
    double rows = 0.0, cpu = 0.0;
    while (const SegmentRow* row = reader.next(layout)) {
      rows += 1.0;
      cpu += std::strtod(std::string(row->wall).c_str(), nullptr);
    }
    if (cpu > 0.0) activity.per_second += rows / cpu;
  }
  return activity;
}

Json stop_json(const StudyTable& table) {
  if (!table.rule()) return nullptr;
  const StopRule& rule = *table.rule();
  Json intervals = Json::array();
  for (const StopInterval& interval : rule.intervals()) {
    intervals.push_back({{"estimate", interval.estimate}, {"half_width", interval.half_width}});
  }
  return {{"n", rule.end().value_or(rule.looked_at())}, {"intervals", intervals}};
}

/// Returns whether something is left.
bool show(const std::string& given, const CommonOptions& common, int& exit_code) {
  StudyInFolder opened = open_kept(given, StudyUse::look, common);
  exit_code = opened.exit_code;
  if (!opened.study) return false;
  StudyTable table(*opened.study, opened.folder);
  table.look(kept_mark(opened.folder), {}, warn_of_damage(common));
  const Activity activity = activity_of(opened.folder, opened.study->layout());
  const std::uint64_t points = table.wanted(), done = table.done(), left = points - std::min(points, done);
  const double seconds = activity.per_second > 0.0 ? static_cast<double>(left) / activity.per_second : 0.0;
  const Json seconds_left = left == 0 ? Json(0) : activity.per_second > 0.0 ? Json(seconds) : Json(nullptr);
  if (common.json) {
    print_json({{"points", points},
                {"done", done},
                {"failed", table.failed()},
                {"left", left},
                {"active", activity.active},
                {"per_second", activity.per_second},
                {"seconds_left", seconds_left},
                {"stop", stop_json(table)}});
    return left > 0;
  }
  std::string text = fmt::format("{}: {} of {} points done, {} failed, {} left\n", opened.study->plan().name(), done,
                                 points, table.failed(), left);
  if (activity.active > 0 && left > 0) {
    text += fmt::format("  active     {} processes, {:.3g} /s, left {}\n", activity.active, activity.per_second,
                        clock_text(seconds));
  }
  if (const auto& rule = table.rule()) {
    text += fmt::format("  stop       {} samples{}\n", rule->end().value_or(rule->looked_at()),
                        rule->end() && !rule->reached() ? ", not reached: it takes more `points`" : "");
    for (const StopInterval& interval : rule->intervals()) {
      text += fmt::format("             {:.6g} +- {:.3g}\n", interval.estimate, interval.half_width);
    }
  }
  print(text);
  return left > 0;
}

}  // namespace

int study_status(const StudyOptions& options, const CommonOptions& common) {
  const std::string& given = only_study(options, "status", "DIR");
  const auto& interrupts = watch_interrupts();
  int exit_code = 0;
  while (show(given, common, exit_code) && options.watch && interrupts == 0) {
    for (int turn = 0; turn < 20 && interrupts == 0; ++turn)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return exit_code;
}

}  // namespace freeplay
