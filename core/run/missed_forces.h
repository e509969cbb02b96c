// MissedForces: forces that act between the ends of steps which an accuracy chooses, and that these steps do not have.
#pragma once

namespace freeplay {

struct RunContext;

/// A row inside of a step has the accelerations of the forces that act there. The motion between the ends of the step
/// has others where a force acts for less time than the step takes, as one that code of a plugin makes of the position.
struct MissedForces {
  /// As many times what a step may err by. Smooth motion stays below 2, that of light bodies on stiff springs, whose
  /// accelerations amplify what their positions are off by, below 1000.
  static constexpr double allowed = 1e4;

  double times = 0.0;   ///< what the interpolation may be off by for that, in units of what a step may err by
  double at = 0.0;      ///< when [s]
  double length = 0.0;  ///< of the step [s]
  int body = 0;         ///< that is moved most by it

  /// Adds a warning and the doubt `unresolved-input` where that is more than is allowed.
  [[gnu::cold]] void say(RunContext& run) const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.times, self.at, self.length, self.body);
  }
};

}  // namespace freeplay
