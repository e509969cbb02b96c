#include "python/asked_analysis.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>
#include <variant>

#include "analysis/analyse.h"
#include "drawing/analysis_map.h"
#include "python/refusal.h"

namespace freeplay {
namespace {

/// Calls `tick` in the thread of the caller alone, at most ten times a second.
class AnalysisPulse {
 public:
  explicit AnalysisPulse(const std::function<bool()>& tick) : tick_(tick) {}

  void beat() {
    if (stopped_) throw AnalysisStopped();
    if (std::this_thread::get_id() != caller_) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    if (tick_()) return;
    stopped_ = true;
    throw AnalysisStopped();
  }

 private:
  const std::function<bool()>& tick_;
  const std::thread::id caller_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::atomic<bool> stopped_ = false;
};

AnalysedColumn column_of(const AnalysisTable& table, std::size_t place) {
  AnalysedColumn column{.name = table.columns[place]};
  const auto is_word = [&](const std::vector<AnalysisCell>& row) {
    return std::holds_alternative<std::string>(row[place]);
  };
  const bool words = std::ranges::any_of(table.rows, is_word);
  for (const std::vector<AnalysisCell>& row : table.rows) {
    const double* const number = std::get_if<double>(&row[place]);
    if (words) {
      column.words.push_back(number != nullptr ? std::string() : std::get<std::string>(row[place]));
    } else {
      column.numbers.push_back(std::isfinite(*number) ? *number : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return column;
}

AskedAnalysis asked_of(AnalysisResult result, std::string picture, AnalysisPulse& pulse) {
  AskedAnalysis asked{.columns = {},
                      .rows = result.table.rows.size(),
                      .summary = std::move(result.table.summary),
                      .csv = result.table.csv([&] { pulse.beat(); }),
                      .map = std::move(picture),
                      .warnings = std::move(result.warnings)};
  for (std::size_t place = 0; place < result.table.columns.size(); ++place) {
    asked.columns.push_back(column_of(result.table, place));
    pulse.beat();
  }
  return asked;
}

}  // namespace

AskedAnalysis analyse_model(const OpenedModel& opened, const AnalysisWords& words, AskedMap map, int threads,
                            const std::function<bool()>& tick) {
  require_sense(words);
  AnalysisPulse pulse(tick);
  try {
    const LoadedModel loaded = opened.read_again();  // a frame may be added
    Model& model = *loaded.model;
    if (words.branches) require_planar(loaded, "--branches");
    if (!words.elbow.empty()) require_planar(loaded, "--elbow");
    const TickOf tick_of = [&](const char*, std::size_t) { return [&](long) { pulse.beat(); }; };
    const PlatformOverrides overrides = platform_overrides(model, words);
    IdealMechanism mechanism(model, platform_of(model, overrides));
    const AnalysisRequest request = request_of(mechanism, words, threads);
    const RequestedStations stations(mechanism, request, tick_of);
    AnalysisResult result = analyse(mechanism, request, stations, tick_of);
    std::string picture;
    if (map != AskedMap::none) {
      const bool coloured = map == AskedMap::coloured;
      picture = analysis_map_svg(mechanism, request, stations, result.table, coloured, tick_of);
      Making making{
          .made = "analyze", .command = "freeplay analyze", .arguments = arguments_of(words, coloured), .build = {}};
      if (!words.samples.empty()) making.seed = seed_of(words);
      picture = opened.with_record(picture, model, std::move(making));
    }
    return asked_of(std::move(result), std::move(picture), pulse);
  } catch (const Error& error) {
    opened.refuse(error);
  }
}

}  // namespace freeplay
