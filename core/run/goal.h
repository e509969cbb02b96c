// RunGoal: how far a run is to go before its caller looks at it.
#pragma once

#include <limits>

namespace freeplay {

/// Whichever comes first, and the end of the run before all.
struct RunGoal {
  double until = std::numeric_limits<double>::infinity();  ///< a step ends there [s]
  long rows = std::numeric_limits<long>::max();            ///< output instants to pass
  long steps = std::numeric_limits<long>::max();           ///< to accept
};

}  // namespace freeplay
