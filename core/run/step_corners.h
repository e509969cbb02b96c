// StepCorners: corners of inputs in a step of fixed size and at its end.
#pragma once

#include <vector>

#include "run/drive_kinks.h"
#include "run/step_attempt.h"

namespace freeplay {

/// Such a step goes over corners. Forces may jump there, so that powers are integrated part by part, and a step that
/// ends at one has the forces before it to its end.
class StepCorners {
 public:
  StepCorners(RunContext& run, StepAttempt& attempt);

  struct Corner {
    double time;
    bool of_motion;  ///< of a prescribed one
  };
  /// Whether the run has any.
  bool any() const { return run_.kinks.any() || load_kinks_.any(); }
  /// Lists those from the accepted state to `until`, unless they are known.
  void list(double until);
  const std::vector<Corner>& all() const { return corners_; }
  /// The last of them that is at t but for rounding; infinite: none.
  double at(double t) const;
  /// Where a step that ends at a corner takes its forces from.
  double before(double corner) const { return corner - near_; }

  /// Whether the run ends there: nothing is to follow such a corner.
  bool is_last(double corner) const { return corner >= run_.settings.end - near_; }

  /// The energy of the step that was just made, if corners are inside or at its end. Else, or where something cannot
  /// be evaluated, false and nothing is done.
  bool add_energy();
  /// The run goes on from a corner at the accepted state with what acts after it. False when the run is over.
  bool pass(double corner);
  /// Powers at t, in the step that was just made or a little beyond its end, with the forces that act at that very
  /// time. False where something cannot be evaluated.
  bool flow_inside(double t, std::span<double> powers);

 private:
  RunContext& run_;
  StepAttempt& attempt_;
  DriveKinks load_kinks_;
  std::vector<Corner> corners_;
  double from_ = unbounded, near_ = 0.0;
  std::vector<double> flow_begin_, flow_half_way_, flow_end_;
};

}  // namespace freeplay
