// StepEvents: finds the zero crossings of joints inside an accepted step and tells the joints.
#pragma once

#include <vector>

#include "run/sink.h"
#include "system/system.h"

namespace freeplay {

/// Fixed-step runs shorten nothing for events: after a step is accepted every crossing is found on the cubic of
/// (g, g') and the joint's on_event() is called with the state interpolated there (cubic in q, cubic in v).
class StepEvents {
 public:
  explicit StepEvents(const System& system);

  /// Advances z and h of `after` over the events between `before` and `after`; `e_before` and `e_after` are evaluated
  /// there (markers and coordinates of all joints). False, with `fault`, when a joint fails.
  bool apply(const State& before, const Evaluation& e_before, State& after, const Evaluation& e_after, Fault& fault);
  /// Tells rising events whose function is past zero already when the run starts.
  bool at_start(State& start, const Evaluation& e, Fault& fault);

  /// Events of the last call in order of time, then of declaration.
  struct Happening {
    double time;
    int joint, event;
    std::size_t fields;  ///< offset into field_values()
    std::size_t count;
  };
  const std::vector<Happening>& happenings() const { return happenings_; }
  std::span<const double> fields(const Happening& h) const { return {values_.data() + h.fields, h.count}; }

 private:
  bool apply_joint(int joint, const State& before, const Evaluation& e_before, State& after, const Evaluation& e_after,
                   Fault& fault);
  bool functions(int joint, const Point& point, const Evaluation& e, std::span<double> g, std::span<double> rate,
                 Fault& fault) const;
  bool tell_inside(int joint, int event, double s, const State& before, State& after, Fault& fault);
  bool tell(int joint, int event, const Point& here, const Evaluation& e, State& state, Fault& fault);

  const System& system_;
  State between_;
  Evaluation e_between_;
  std::vector<int> watched_;
  std::vector<double> g0_, r0_, g1_, r1_, values_;
  std::vector<Happening> happenings_;
};

}  // namespace freeplay
