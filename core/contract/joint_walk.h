// JointWalk: leads a joint along a motion of its markers, with the calls that the host makes in every step.
#pragma once

#include "contract/joint_probe.h"

namespace freeplay {

/// Takes z over a step of length `dt` by a linearly implicit rule, so that stiff ones stay bounded.
void advance_internal(const JointProbe& probe, JointMoment& trial, double dt);

class JointWalk {
 public:
  JointWalk(const JointProbe& probe, const JointMoment& start) : probe_(probe), now_(start) {}

  /// Takes a step of length `dt` to `next`; events are passed on at its end.
  void step(const MarkerPair& next, const Twelve& acceleration, double dt);

  const JointMoment& now() const { return now_; }
  /// The end of the last step before its events were passed on and it was accepted.
  const JointMoment& tried() const { return tried_; }

 private:
  void handle_events(JointMoment& trial) const;

  const JointProbe& probe_;
  JointMoment now_, tried_;
};

/// A closed relative motion of the markers in the plane, once around in `period`. A joint with play is led through
/// contacts and flights, starting in flight; any other around the place where the path begins.
class ClosedPath {
 public:
  ClosedPath(const JointProbe& probe, RandomNumbers& random);
  double period() const { return period_; }
  MarkerPair at(double time) const;
  Twelve acceleration(double time) const;

 private:
  Twelve displacement(double time) const;
  MarkerPair start_;
  double play_ = 0.0, period_ = 1.0;
};

}  // namespace freeplay
