// EndCheck: what ends a run after a step that was accepted: a stop condition, or the user.
#pragma once

#include <chrono>
#include <vector>

#include "run/hooks.h"
#include "run/recorder.h"

namespace freeplay {

class EndCheck {
 public:
  EndCheck(RunContext& run, Recorder& recorder);

  void start_clock() { started_ = Clock::now(); }
  /// While the caller is at work.
  void pause_clock() { before_ = seconds(); }
  double spent() const { return before_; }
  double seconds() const { return before_ + std::chrono::duration<double>(Clock::now() - started_).count(); }
  /// Each returns false when the run is over, with its outcome filled. The second also reports how far the run is.
  bool check_stop();
  bool check_interrupt(const RunHooks& hooks);

 private:
  using Clock = std::chrono::steady_clock;

  RunContext& run_;
  Recorder& recorder_;
  std::vector<int> stop_columns_;
  Clock::time_point started_;
  double before_ = 0.0, last_progress_ = 0.0;
};

}  // namespace freeplay
