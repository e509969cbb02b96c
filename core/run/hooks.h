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
  StepSink* steps = nullptr;   ///< looks at all of them
  Profile* profile = nullptr;  ///< counts where the time goes
  /// For tests of what finds wrong runs: steps go over what forces and other inputs do inside them.
  bool blind_to_inputs = false;
};

}  // namespace freeplay
