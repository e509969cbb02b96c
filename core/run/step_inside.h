// StepInside: states inside a step that was just made.
#pragma once

#include <vector>

#include "run/step_attempt.h"

namespace freeplay {

class StepInside {
 public:
  StepInside(RunContext& run, RunFailure& failure, StepAttempt& attempt);

  /// The state in `between` with its constraints, accelerations and multipliers.
  bool settle_between();
  /// The same for a state that the run can do without: false, too, near a singular position, where it may be wrong. The
  /// recorded regularity stays as it was.
  bool settle_aside();
  /// A consistent state at t inside the step, in `between` and e_between, as good as the ends of the step are. False
  /// when the run is over.
  bool look_inside(double t);

 private:
  void know_inside();
  double error_by_missing(double s);
  double change_of_memory(std::size_t place);
  bool settle_inside(double t);
  void note_missed(double s);

  RunContext& run_;
  RunFailure& failure_;
  StepAttempt& attempt_;
  std::vector<double> inner_before_, defect_, rate_defect_, start_rate_, end_rate_;
  std::vector<double> memory_before_, memory_change_;  // of internal variables of joints
};

}  // namespace freeplay
