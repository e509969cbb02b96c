// ContactAdvice: whether the steps were short enough for the impacts.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "model/model.h"
#include "run/sink.h"

namespace freeplay {

/// Looks at events with the fields `duration` and `steps` of a contact that ended: from Settings::discard on, but for
/// hard impacts from the start on, as what steps do not resolve there is missing in the motion afterwards.
class ContactAdvice : public Sink {
 public:
  [[gnu::cold]] explicit ContactAdvice(const Model& model);

  void row(std::span<const double>) override {}
  void event(const EventRecord& record) override;
  bool ok() const override { return true; }

  long under_resolved() const { return under_resolved_; }
  /// Fewest steps of a contact; NaN when none ended.
  double fewest_steps() const { return fewest_steps_; }
  /// The same of hard impacts alone, whose largest force is of the same power of ten as the largest of their joint in
  /// the whole run or from Settings::discard on; infinite without.
  double fewest_steps_of_hard() const;
  /// Largest speed at which a contact of this joint began, from the start of the run on [m/s]; 0 without one.
  double approach_speed(int joint) const {
    const int place = place_[static_cast<std::size_t>(joint)];
    return place < 0 ? 0.0 : joints_[static_cast<std::size_t>(place)].speed;
  }
  /// Contacts that ended, and the steps that each should take (Settings::per_contact).
  long ended() const { return ended_; }
  double per_contact() const { return per_contact_; }
  /// Step that gives every contact so many steps [s]; NaN when all have them.
  double step() const { return step_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.joints_, self.under_resolved_, self.ended_, self.fewest_steps_, self.step_);
  }

 private:
  struct Fields {
    int duration = -1, steps = -1, force = -1, speed = -1;
  };
  static constexpr int decades = 24;             // of forces, the first of all below 1e-8 N
  using ByDecade = std::array<double, decades>;  // fewest steps, by the power of ten of an impact's largest force
  struct OfJoint {
    OfJoint() {
      all.fill(std::numeric_limits<double>::infinity());
      counted = all;
    }
    ByDecade all, counted;  // from the start on, and from Settings::discard on
    double speed = 0.0;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.all, self.counted, self.speed);
    }
  };
  double from_, per_contact_;
  std::vector<std::vector<Fields>> fields_;  // joint, event
  std::vector<OfJoint> joints_;              // with events
  std::vector<int> place_;                   // of each joint among these, or -1
  long under_resolved_ = 0, ended_ = 0;
  double fewest_steps_ = std::numeric_limits<double>::quiet_NaN(), step_ = fewest_steps_;
};

}  // namespace freeplay
