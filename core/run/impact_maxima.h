// ImpactMaxima: the largest normal force and penetration of a contact inside of steps, for the event that ends it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/channel.h"
#include "run/step_events.h"
#include "system/joints.h"

namespace freeplay {

/// A joint knows its forces at the ends of steps alone; steps that an accuracy chooses are long beside an impact. So
/// the fields `max_fn` and `max_delta` of an event that ends a contact become at least what any row or peak inside of
/// the contact has. Of joints with several contacts the channels do not say whose they are: those stay as they are.
class ImpactMaxima {
 public:
  ImpactMaxima(const Joints& joints, const Channels& channels);

  /// The row of a state inside of a step.
  void see(std::span<const double> row);
  /// The events of the step, after all rows inside of it.
  void raise(StepEvents& events);

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.joints_);
  }

 private:
  struct EventKind {
    bool begins, ends;
    std::array<int, 2> fields;  ///< force and penetration: indices, or -1
  };
  struct OfJoint {
    int joint;
    std::array<int, 2> columns;  ///< of normal force and penetration; the second may be -1
    std::vector<EventKind> kinds;
    std::array<double, 2> largest{};
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.largest);
    }
  };
  std::vector<OfJoint> joints_;
};

}  // namespace freeplay
