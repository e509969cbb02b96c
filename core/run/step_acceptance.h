// StepAcceptance: a step that stands becomes the accepted state.
#pragma once

#include <vector>

#include "run/corners.h"
#include "run/doubts.h"
#include "run/energy_growth.h"
#include "run/recorder.h"

namespace freeplay {

/// Where a function returns false the run is over, with its outcome filled.
class StepAcceptance {
 public:
  StepAcceptance(RunContext& run, RunFailure& failure, StepAttempt& attempt, Recorder& recorder, RunDoubts& doubts,
                 EnergyGrowth& growth, Corners& corners);

  /// The start of a run.
  bool begin();
  /// Of a step whose end is evaluated in e_trial: events first, then the joints' history, then it is the accepted
  /// state. `located`: an event at its end, which its function may have passed by `late`. A finite `kink` lies at its
  /// end.
  bool accept(const StepEvents::Passage& located = {}, double late = 0.0, double kink = unbounded);

 private:
  void add_energy();
  bool apply_events(const StepEvents::Passage& located, double late);
  /// What acts may have changed at the end of the step.
  bool go_on_from(bool changed, double kink);

  RunContext& run_;
  RunFailure& failure_;
  StepAttempt& attempt_;
  Recorder& recorder_;
  RunDoubts& doubts_;
  EnergyGrowth& growth_;
  Corners& corners_;
  std::vector<double> flow_half_way_;
};

}  // namespace freeplay
