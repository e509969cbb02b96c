// ProgressLine: how far a run is, on a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace freeplay {

/// One line on stderr that is written over and goes away at the end. Silent unless `shown`.
class ProgressLine {
 public:
  ProgressLine(double start, double end, bool shown);
  /// Of something that is counted.
  explicit ProgressLine(bool shown) : ProgressLine(0.0, 0.0, shown) {}
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows simulated time `t` [s]; at most ten times a second.
  void update(double t, long steps);
  /// Shows how many of `total` are done, and what they are.
  void update(const char* what, long done, long total);
  /// Another line, where it is `due()`.
  void show(const std::string& line);
  bool due();
  /// Takes the line away, as for another text.
  void clear();

 private:
  double elapsed() const;

  double start_, end_;
  bool shown_;
  std::size_t width_ = 0;
  std::chrono::steady_clock::time_point began_, last_{};
};

/// 00:12, with hours only where there are any.
std::string clock_text(double seconds);
/// `  42 %  t = 0.252 / 0.6 s  126 000 steps  eta 00:12`, after `elapsed` seconds of work.
std::string progress_text(double start, double end, double t, long steps, double elapsed);
/// `  42 %  16 800 / 40 000 poses found  eta 00:12`.
std::string progress_text(const char* what, long done, long total, double elapsed);

}  // namespace freeplay
