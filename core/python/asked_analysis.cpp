#include "python/asked_analysis.h"

#include <atomic>
#include <chrono>
#include <thread>

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

}  // namespace

AskedAnalysis analyse_model(const OpenedModel& opened, const AnalysisWords& words, AskedMap map, int threads,
                            const std::function<bool()>& tick) {
  require_sense(words);
  AnalysisPulse pulse(tick);
  try {
    const LoadedModel loaded = opened.read_again();  // a frame may be added
    Model& model = *loaded.model;
    if (words.kind == "workspace") require_planar(loaded, "analyze workspace");
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
    return {std::move(result.table), std::move(picture), std::move(result.warnings)};
  } catch (const Error& error) {
    opened.refuse(error);
  }
}

}  // namespace freeplay
