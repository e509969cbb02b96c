// AdaptiveRun: a run with error control: every located event ends a step, output rows are taken from inside the steps.
#pragma once

#include <cstddef>

#include "run/error_budget.h"
#include "run/event_bracket.h"
#include "run/event_pursuit.h"
#include "run/force_kinks.h"
#include "run/goal.h"
#include "run/parts.h"
#include "run/slow_steps.h"
#include "run/step_control.h"

namespace freeplay {

class AdaptiveRun {
 public:
  AdaptiveRun(const RunParts& parts, EventPursuit& pursuit);

  /// From the accepted state to `goal`. False once the run is over.
  bool advance(const RunHooks& hooks, const RunGoal& goal);
  /// Once the run is over.
  void doubt_steps() { slow_.add_doubt(); }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.control_, self.budget_, self.velocity_allowed_, self.slow_);
  }

 private:
  /// The step that is being sought.
  struct Search {
    double dt = 0.0;               ///< of the next attempt [s]
    double goal = 0.0;             ///< beyond which it does not go [s]
    double kink = unbounded;       ///< the corner after the goal, unless that is the end of the run [s]
    int limiting = -1;             ///< joint that asked for a short step
    StepEvents::Passage hunted{};  ///< event at which it is to end
    EventBracket bracket{};        ///< lengths of attempts around it
    int hunts = 0;                 ///< attempts to end there
    int given_up = 0;              ///< hunts that were given up for a shorter step
    std::size_t detours = 0;
    double asked = 0.0;            ///< length before detours [s]
    bool quick = false;            ///< an input acts for a short time
    bool unbounded_slope = false;  ///< of it, at a corner beside the step
    bool at_force_kink = false;    ///< the attempt is to end there
    int looks = 0;                 ///< at what loads do inside that had it shortened
    double stop = 0.0;             ///< length at which a condition to stop is met [s]
    double hidden = 1.0;           ///< errors of the last attempt are so many times what it shows
  };
  enum class Found { no, yes, failed };  ///< a step that may stand; failed: the run is over

  bool step(double until);
  bool begin_search(double until, Search& search);
  Found attempt(Search& search);
  Found shorten(Search& search, bool converged);
  bool look_ahead(double tried, double dt);
  Found judge(Search& search);
  bool gives_up_hunt(Search& search);
  bool resolve_motion_loads(Search& search, double& dt);
  Found end_at_force_kink(Search& search);
  Found end_at_event(Search& search);
  Found end_at_stop(Search& search);
  void allow_error(Search& search);
  bool in_contact(const Evaluation& e) const;
  bool bounded_step(double& dt, int& limiting_joint);
  bool take_detour(bool passed, Search& search);
  bool accept(const Search& search);

  const RunParts parts_;
  RunContext& run_;
  EventPursuit& pursuit_;
  ForceKinks force_kinks_;
  StepControl control_;
  ErrorBudget budget_;  // of steps over short loads
  SlowSteps slow_;
  double velocity_allowed_;  // by which velocities may err in the step to come [m/s]
};

}  // namespace freeplay
