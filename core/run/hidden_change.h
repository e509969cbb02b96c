// HiddenChange: a load or a spring that does more inside a step of one size than both ends of it show.
#pragma once

#include <string>

namespace freeplay {

struct RunContext;

/// More than this part of a range in the run is not shown by steps of one size.
constexpr double hidden_part = 0.1;

struct HiddenChange {
  double beyond = 0.0;  ///< farthest beyond what it is at both ends
  double at = 0.0;      ///< when [s]
  double range = 0.0;   ///< of all that was seen of it in the run
  const char* unit;

  /// Whether that is more than steps of one size need not show, and of a force or torque more than roundings of the
  /// weight of all bodies.
  bool counts(const RunContext& run) const;
  /// Adds a warning and the doubt `unresolved-input` of what is called `element`.
  [[gnu::cold]] void say(RunContext& run, const std::string& element) const;
};

}  // namespace freeplay
