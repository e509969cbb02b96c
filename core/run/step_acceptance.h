// StepAcceptance: a step that stands becomes the accepted state.
#pragma once

#include <vector>

#include "run/corners.h"
#include "run/doubts.h"
#include "run/energy_growth.h"
#include "run/recorder.h"
#include "run/step_corners.h"

namespace freeplay {

/// Where a function returns false the run is over, with its outcome filled.
class StepAcceptance {
 public:
  [[gnu::cold]] StepAcceptance(RunContext& run, RunFailure& failure, StepAttempt& attempt, Recorder& recorder,
                               RunDoubts& doubts, EnergyGrowth& growth, Corners& corners, StepCorners& step_corners);

  /// The start of a run.
  bool begin();
  /// What lies at the end of a step.
  struct End {
    StepEvents::Passage located{};  ///< an event
    double late = 0.0;              ///< by which its function may have passed zero
    double kink = unbounded;        ///< a corner of an input, of a run with error control [s]
    double corner = unbounded;      ///< the same, of a step of fixed size [s]
    bool has_energy = false;        ///< the account of energy has this step already
  };
  /// Of a step whose end is evaluated in e_trial: events first, then the joints' history, then it is the accepted
  /// state.
  bool accept(const End& end);

 private:
  void add_energy();
  bool drivers_change(double dt);
  /// What joints lost as their history changed. False where one says no number.
  bool add_history_losses();
  bool apply_events(const StepEvents::Passage& located, double late);
  /// What acts may have changed at the end of the step.
  bool go_on_from(bool changed, const End& end);

  RunContext& run_;
  RunFailure& failure_;
  StepAttempt& attempt_;
  Recorder& recorder_;
  RunDoubts& doubts_;
  EnergyGrowth& growth_;
  Corners& corners_;
  StepCorners& step_corners_;
  std::vector<double> flow_half_way_, flow_end_;
  std::vector<std::size_t> may_lose_;  // joints that are handed JointInput::dissipated
};

}  // namespace freeplay
