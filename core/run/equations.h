// RunEquations: the equations of motion that a run solves, and where it begins.
#pragma once

#include "assembly/assembly.h"
#include "system/system.h"

namespace freeplay {

/// Bodies that drivers and welds place are no unknowns, unless constraints are redundant. Constant once it is built:
/// any number of simulations may use one at the same time, in threads of their own.
class RunEquations {
 public:
  /// `whole` has all bodies for its unknowns and `start` is its assembled start; both must outlive the equations.
  RunEquations(const System& whole, const Start& start);
  RunEquations(const RunEquations&) = delete;
  RunEquations& operator=(const RunEquations&) = delete;

  const System& whole() const { return whole_; }
  const Start& start() const { return start_; }
  const System& system() const { return system_; }
  /// The start, of the unknowns; without memory of an integrator.
  const State& first_state() const { return first_state_; }

 private:
  const System& whole_;
  const Start& start_;
  System system_;
  State first_state_;
};

}  // namespace freeplay
