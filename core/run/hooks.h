// RunHooks: who is asked and called while a run goes on.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "run/step_sink.h"
#include "system/profile.h"

namespace freeplay {

struct RunHooks {
  const std::atomic<int>* interrupt = nullptr;  ///< nonzero: end after the present step
  /// Called at most ten times a second: time reached, steps so far.
  std::function<void(double, long)> progress;
  /// Called when something about the run is worth knowing before its end.
  std::function<void(const std::string&)> notice;
  /// Called after every accepted step, when its rows and events are written: the instants at which to save().
  std::function<void()> stepped;
  StepSink* steps = nullptr;   ///< receives every accepted step
  Profile* profile = nullptr;  ///< counts where the time goes
  /// For tests of checks that find wrong runs: changes of forces and other inputs inside a step are not resolved.
  bool blind_to_inputs = false;
};

}  // namespace freeplay
