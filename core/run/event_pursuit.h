// EventPursuit: a step with error control that meets an event ends there.
#pragma once

#include <vector>

#include "run/event_bracket.h"
#include "run/step_inside.h"

namespace freeplay {

class EventPursuit {
 public:
  static constexpr int most_hunts = 40;  ///< to end a step at an event

  EventPursuit(RunContext& run, RunFailure& failure, StepAttempt& attempt, StepInside& inside);

  /// The length of the step to try in place of one of the length dt that erred too much: `shorter`, or to an event that
  /// it met before, whose change of forces may be what it erred by.
  double before_event(double dt, double shorter, StepEvents::Passage& hunted);
  /// Whether the step that was just made may stand (`done`): no located event lies inside, or `hunted` lies at its end.
  /// Else `dt` is where to try next: no step goes beyond the time `goal`. False when the run is over.
  bool pursue(StepEvents::Passage& hunted, EventBracket& bracket, double& dt, int hunts, double goal, bool& done);
  /// Ends the step that was just made at the event inside it or a little after, about `dt` after its start and before
  /// `longest`, by the interpolated motion. False where the event must be hunted by steps, or the run is over.
  bool end_inside(const StepEvents::Passage& hunted, double dt, int hunts, double longest);
  /// How far past its zero an event function may be at the end of the step that ends there, whatever its rate.
  double event_lateness() const;

 private:
  bool cut_at(double s, double whole);
  double defect_inside(double dt);
  bool is_sharp(const StepEvents::Passage& end) const;
  double allowed_past(const StepEvents::Passage& end) const;
  double aim_past(const StepEvents::Passage& end, double dt) const;

  RunContext& run_;
  RunFailure& failure_;
  StepAttempt& attempt_;
  StepInside& inside_;
  std::vector<double> defect_;
};

}  // namespace freeplay
