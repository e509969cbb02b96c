// StepAttempt: one try of a step by the integrator, and what joints do before and after it.
#pragma once

#include <vector>

#include "run/failure.h"

namespace freeplay {

/// Where a function returns false the run is over, with its outcome filled, unless it says otherwise.
class StepAttempt {
 public:
  StepAttempt(RunContext& run, RunFailure& failure);

  /// Tries a step of the length dt from the accepted state; the trial state is its end. `converged`: it may stand, as
  /// far as the integrator knows.
  bool make(double dt, bool& converged);
  /// The joints' history in `state`, which enters as that of the accepted state, at the begin of a step of the length
  /// dt from there.
  bool begin_steps(double dt, State& state);
  /// Everything about a state whose accelerations the solver knows, and the loads of driven bodies; in fixed steps only
  /// what joints ask for in every step. False with the fault in `e`.
  bool evaluate_all(State& state, KeptEvaluation& e);
  /// The joints' history at the end of the step.
  bool commit_history();
  /// The integrator starts at the accepted state of a run that begins, where all is evaluated.
  bool start();
  /// The same where something else acts from there on: accelerations are solved for anew.
  bool restart();

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.angle_then_, self.turns_are_due_);
  }

 private:
  /// The numbers that an attempt may use as it likes; after them come marks.
  Span<double> scratch() { return {scratch_.data(), scratch_.size() - guard::marks}; }
  [[gnu::noinline]] bool begin_step_of(int joint, double dt, const Point& start, State& state);
  [[gnu::noinline]] bool commit_history_of(int joint);
  bool check_step(double dt);
  bool have_turned(const Evaluation& e) const;
  void note_turns(const Evaluation& e, std::span<double> history);

  RunContext& run_;
  RunFailure& failure_;
  std::vector<double> scratch_;
  std::vector<int> with_history_;
  struct Turn {
    std::size_t slot, joint;
  };
  std::vector<Turn> turns_;         // into h
  std::vector<double> angle_then_;  // of bodies, when turns were noted last; empty where they are in every step
  bool turns_are_due_ = true;       // in the step that is being accepted
};

}  // namespace freeplay
