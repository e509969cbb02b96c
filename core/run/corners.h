// Corners: instants at which inputs of a run jump or have a kink, and how the run goes over them.
//
// Runs with error control end a step just before one. Where a ramp of smooth() begins or ends they go on; where a load
// jumps they start again just after it, and also where a motion that a driver prescribes has a kink: a jump of its
// acceleration is legal, a jump of its speed is a blow.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "run/input_activity.h"
#include "run/step_attempt.h"

namespace freeplay {

/// Where a function that returns a bool returns false the run is over, unless it says otherwise.
class Corners {
 public:
  [[gnu::cold]] Corners(RunContext& run, RunFailure& failure, StepAttempt& attempt);

  /// A hook of tests: switches the search off, so that a test can make a wrong run.
  void go_blind() { inputs_.reset(); }

  /// The next corner that a step of the length dt, or a few times that, can end before.
  bool next_corner(double dt, double& corner);
  /// The time at which a step before it ends.
  static double before(double kink);
  /// Shortens a step of the length dt from the accepted state that does not resolve what depends on time; the second
  /// once it is made, for joints where it has brought them.
  bool resolve_inputs(double& dt);
  bool resolves_joints(double& dt);
  /// The step that was just made ends before `corner`, or at none. Returns what may jump there.
  CornerKind end_step(std::optional<double> corner);
  /// Whether an input acts for a short time from the accepted state on; and whether steps there may err more than they
  /// show, and how many times (InputActivity).
  bool act_quickly() { return inputs_ && inputs_->acts_quickly(run_.accepted.t()); }
  bool hide_errors() const { return inputs_ && inputs_->hides_errors(run_.accepted.t()); }
  double hidden_error(double dt) const { return inputs_ ? inputs_->hidden_error(run_.accepted.t(), dt) : 1.0; }
  /// From just before `kink`, at which end_step() knows that the step ends, to just after it.
  bool pass_kink(double kink);

  /// Of a step of fixed size that went over a kink: whether the speed of a driver jumps there; and the work of the
  /// blow.
  bool note_jumps(double kink);
  /// Whether the position itself of one jumps there, and so ends the run.
  [[gnu::cold]] bool stops_at_jump(double kink);
  void book_jump(double kink);

  /// Once the run is over: jumps of speeds; inputs that do more inside a step than it can see.
  [[gnu::cold]] void format_jumps();
  [[gnu::cold]] void format_unresolved();

  void save(ArchiveWriter& archive) const;
  void restore(ArchiveReader& archive);

 private:
  [[gnu::cold]] void format_too_short();
  [[gnu::cold]] void format_declared(double step, std::span<const std::string> said);
  bool look_beside(double kink);
  [[gnu::cold]] bool fail_at_jump(double kink, int row);
  bool loads_jump(double corner);
  void note_driven(const Evaluation& e);
  double moved_around_kink(double passed) const;
  int row_that_jumps(double passed) const;
  void book_impulses(Evaluation& after);

  RunContext& run_;
  RunFailure& failure_;
  StepAttempt& attempt_;
  const bool one_at_end_;                             // of the run
  std::optional<InputActivity> inputs_;               // with error control, unless a test blinds it
  std::vector<InputActivity::Unresolved> too_short_;  // changes that it does not see
  CornerKind corner_kind_ = CornerKind::smooth;       // of the corner at which the step being accepted ends
  struct SpeedJump {
    int count = 0;
    double time = 0.0, from = 0.0, to = 0.0;  ///< of the first
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.count, self.time, self.from, self.to);
    }
  };
  std::vector<SpeedJump> speed_jumps_;  // by driver
  std::vector<TimeValue> motion_before_, motion_after_;
  std::vector<double> q_before_, v_before_, driven_change_, impulses_;
};

}  // namespace freeplay
