// JointWalk: leads a joint along a motion of its markers, with the calls that the host makes in every step.
#pragma once

#include "contract/joint_probe.h"

namespace freeplay {

class JointWalk {
 public:
  JointWalk(const JointProbe& probe, const JointMoment& start) : probe_(probe), now_(start) {}

  /// Takes a step of length `dt` to `next`. Internal variables follow by a linearly implicit rule, so that stiff ones
  /// stay bounded; events are passed on at the end of the step.
  void step(const MarkerPair& next, const Twelve& acceleration, double dt);

  const JointMoment& now() const { return now_; }

 private:
  void advance_internal(JointMoment& trial, double dt) const;
  void tell_events(JointMoment& trial) const;

  const JointProbe& probe_;
  JointMoment now_;
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
