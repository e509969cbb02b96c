// Outcome: how a run ended.
#pragma once

#include <string>
#include <vector>

#include "run/trust.h"

namespace freeplay {

enum class RunStatus { completed, stopped, failed, interrupted };

/// What moves to and fro by itself, and how long it takes.
struct Swing {
  int body = -1;
  double period = 0.0;  ///< [s]
};

/// How a run ended. A failed run keeps everything up to the last accepted step.
struct Outcome {
  RunStatus status = RunStatus::completed;
  int exit_code = 0;          ///< 0, 4 (numerical failure), 5 (a plugin failed), 6 (a sink failed) or 130
  std::string reason;         ///< which condition stopped it, or what failed, where, and what to try; else empty
  double time = 0.0;          ///< reached [s]
  double wall_seconds = 0.0;  ///< from the assembled start to the last accepted step
  double smallest_step = 0.0, largest_step = 0.0;  ///< of the accepted ones [s]; 0 where there are none
  long steps = 0, rejected = 0, iterations = 0, factorizations = 0, rows = 0, events = 0;
  Swing slowest{};                    ///< looked for where `discard` leaves out the start and no driver prescribes
  std::vector<TrustReason> doubts{};  ///< what the loop itself found against its numbers
};

}  // namespace freeplay
