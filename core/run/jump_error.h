// JumpError: what steps of one size make of a load that jumps inside of them.
#pragma once

#include <optional>
#include <span>

#include "base/expression.h"

namespace freeplay {

/// The times of a run, and of its steps: each row begins a step.
struct StepTimes {
  double from, to, interval, step;  ///< [s]
};

struct JumpError {
  int jumps = 0;      ///< inside of steps
  double part = 0.0;  ///< of the way that the load takes a free mass: the farthest that steps are off it
};

/// A method of second order takes a jump for one in the middle of the step that it is in. What that leaves out or adds
/// is carried on as speed, and adds up where many jumps fall so. Of the load `formula`, whose corners are `times`.
/// Nothing where it has no value, does not jump, or there are too many steps to look at.
[[gnu::cold]] std::optional<JumpError> jump_error(const Expression& formula, std::span<const double> times,
                                                  const StepTimes& run);

}  // namespace freeplay
