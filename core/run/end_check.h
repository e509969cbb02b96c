// EndCheck: what ends a run after a step that was accepted on behalf of the user, and how long it took.
#pragma once

#include <chrono>

#include "run/context.h"
#include "run/hooks.h"

namespace freeplay {

class EndCheck {
 public:
  explicit EndCheck(RunContext& run) : run_(run) {}

  void start_clock() { started_ = Clock::now(); }
  /// While the caller is at work.
  void pause_clock() { before_ = seconds(); }
  double spent() const { return before_; }
  double seconds() const { return before_ + std::chrono::duration<double>(Clock::now() - started_).count(); }
  /// Reports how far the run is. False when it is over, with its outcome filled.
  bool check_interrupt(const RunHooks& hooks);

 private:
  using Clock = std::chrono::steady_clock;

  RunContext& run_;
  Clock::time_point started_;
  double before_ = 0.0, last_progress_ = 0.0;
};

}  // namespace freeplay
