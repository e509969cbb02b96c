// ContactPace: how fast the contacts of a joint swing and how fast their damping lets motion die away.
#pragma once

#include <string>
#include <vector>

#include "run/context.h"

namespace freeplay {

/// The relative motion of a joint's bodies against its contact force at the accepted state, as that of a mass on a
/// spring with a damper: with the mobility W of b against a and the derivatives of the wrench on b by pose and twist,
/// damping = -tr(W dw/dV) [1/s] and swing^2 = -tr(W dw/dx).
struct ContactPace {
  int joint = -1;
  double damping = 0.0;  ///< m/c is 1/damping [1/s]
  double swing = 0.0;    ///< circular frequency without damping [rad/s]
  bool slides = false;   ///< most of the damping is across the direction in which the surfaces press: friction
};

/// Looks at the joints that declare contacts, and knows at which speed each began last.
class ContactPaces {
 public:
  [[gnu::cold]] explicit ContactPaces(RunContext& run);  // these by size: they run once, or once in 100 000 steps

  bool any() const { return !contacts_.empty(); }
  /// After an accepted step: contacts that began in it.
  void note_begins();
  /// The joint in contact that is damped fastest; `joint` is -1 without one.
  [[gnu::cold]] ContactPace fastest();
  /// "its contact (law 'NAME', begun at ... m/s)", or "its friction (law 'NAME')".
  [[gnu::cold]] std::string words(const ContactPace& pace) const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    for (auto& contact : self.contacts_) archive(contact.speed);
  }

 private:
  struct OfJoint {
    int joint;
    std::size_t block;               // of the forces
    std::vector<int> speed_field{};  // by event; -1 where it begins no contact
    double speed = -1.0;             // at which its last contact began; below 0: none has
  };
  [[gnu::cold]] bool look(OfJoint& contact, ContactPace& pace);

  RunContext& run_;
  std::vector<OfJoint> contacts_;
};

}  // namespace freeplay
