// SleepingJoints: joints that a run need not ask for forces.
#pragma once

#include <vector>

#include "system/evaluation.h"

namespace freeplay {

/// Most joints with play fly most of the time, far from what they could touch. Such a joint says once how far it may
/// move (Joint::free_distance); until it has used that up, a step neither begins it nor asks it for forces, events,
/// warnings and commits; steps that the error chooses leave out forces alone. Results are the same as with all joints
/// awake. A step of fixed size in which one moved too far is taken again with all of them awake.
class SleepingJoints {
 public:
  /// Decides on the joints of `context`, which must outlive it.
  SleepingJoints(const Joints& joints, const Forces& forces, EvaluationContext& context);

  /// Before a step of length dt from where `e` is evaluated: decides which joints sleep in it
  /// (EvaluationContext::sleeps). Where dt is infinite none does, and of those within their distance all but the forces
  /// is still evaluated. False, with `fault`, when a joint fails.
  bool begin(double dt, const Point& start, const Evaluation& e, Fault& fault);
  /// After an attempt, and at the end of a step, evaluated in `e`: whether they could. If not, all are awake in the
  /// next attempt.
  bool stayed();
  bool held(double dt, const Evaluation& e);

  /// Besides EvaluationContext::sleeps.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.candidates_, self.all_awake_);
  }

 private:
  struct Candidate {
    int joint, block;  ///< into Forces::blocks()
    int marker_a, marker_b;
    double room = 0.0, speed = 0.0;  ///< of one that rests: distance that is left [m], relative speed [m/s]
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.room, self.speed);
    }
  };
  void look(Candidate& candidate, const Evaluation& e) const;

  const Joints& joints_;
  EvaluationContext& context_;
  std::vector<Candidate> candidates_;
  bool all_awake_ = false;
};

}  // namespace freeplay
