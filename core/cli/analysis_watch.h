// AnalysisWatch: shows how far an analysis is, and ends it on Ctrl-C.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>

#include "analysis/station.h"
#include "cli/progress_line.h"

namespace freeplay {

/// Thrown out of an analysis that is interrupted.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

/// Watches interrupts from its construction on. The line is for analyses of more than half a second.
class AnalysisWatch {
 public:
  /// `shown`: is there a line at all?
  explicit AnalysisWatch(bool shown);
  /// What is counted up to `total` next, as `what` says. The tick may be called by several threads.
  Tick begin(const char* what, std::size_t total);

 private:
  void count(long done);

  const std::atomic<int>& interrupts_;
  bool shown_;
  const char* what_ = "";
  long total_ = 0;
  std::atomic<long> done_ = 0;
  std::mutex mutex_;  // of the line
  std::optional<ProgressLine> line_;
  std::chrono::steady_clock::time_point began_;
};

}  // namespace freeplay
