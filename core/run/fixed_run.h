// FixedRun: a run in steps of one size.
#pragma once

#include <cstddef>
#include <vector>

#include "run/goal.h"
#include "run/parts.h"
#include "run/step_corners.h"

namespace freeplay {

class FixedRun {
 public:
  FixedRun(const RunParts& parts, StepCorners& step_corners);

  /// From the accepted state to `goal`. False once the run is over.
  bool advance(const RunHooks& hooks, const RunGoal& goal);

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.leg_);
  }

 private:
  /// On the way to the next output instant: steps of one size from an instant that a caller asked for or the output
  /// instant before, the last of which ends there.
  struct Leg {
    double from = 0.0, target = -unbounded;
    double goal = -unbounded;  ///< where the present step of full size ends [s]
    double dt = 0.0;           ///< of the next attempt [s]
    long count = 0, step = 0;  ///< steps of full size: all, and the present one; 0: none has begun
    long steps_before = 0;     ///< accepted before this way
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.from, self.target, self.goal, self.dt, self.count, self.step, self.steps_before);
    }
  };
  bool begin_leg();
  bool step(double until);
  bool accept(double corner);
  bool meets_jump(double end);
  double fastest_turn() const;

  const RunParts parts_;
  RunContext& run_;
  StepCorners& step_corners_;
  std::vector<std::size_t> turning_;  // joints whose turns are counted
  Leg leg_;
};

}  // namespace freeplay
