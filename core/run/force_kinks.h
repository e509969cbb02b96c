// ForceKinks: where the forces of joints have kinks inside a step with error control.
#pragma once

#include <vector>

#include "run/context.h"

namespace freeplay {

/// Both methods of a pair make nearly the same mistake at a kink, such as the speed at which a law of friction changes
/// its formula: a step over one may err by many times what its estimate shows. Steps that end there do not.
class ForceKinks {
 public:
  /// A step ends at a kink inside it where its error estimate times this factor exceeds what is allowed. Larger factors
  /// gain little and cost steps.
  static constexpr double hidden = 8.0;

  explicit ForceKinks(RunContext& run);
  bool any() const { return !joints_.empty(); }

  /// The part of the step that was just made after which a force has a kink, by the secant method; 1 if there is none.
  /// A kink in the first or last fiftieth of the step does not matter and counts as none. False when a joint fails.
  bool first_inside(double& part, Fault& fault);

 private:
  RunContext& run_;
  std::vector<int> joints_;  ///< that have kinks
  std::vector<double> before_, after_;
};

}  // namespace freeplay
