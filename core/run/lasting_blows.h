// LastingBlows: blows that begin a contact which lasts, so that no event ends them.
#pragma once

#include <vector>

#include "system/system.h"

namespace freeplay {

/// Steps in the half wave of a force that give its peak to about a per cent with a method of order two.
inline constexpr double fewest_steps_of_blow = 10.0;

/// Steps of one size that damp what they do not resolve let a journal stay in its bearing after a blow that it would
/// rebound from, with a peak that is too low. Here a blow goes from the beginning of the force of a joint with play to
/// the place where it rises again, after a fall to less than half of its peak.
class LastingBlows {
 public:
  explicit LastingBlows(const System& system);

  /// The end of a step of one size.
  void add(const Evaluation& e);

  struct Fewest {
    double steps = unbounded;
    int joint = -1;
  };
  /// The fewest steps of a hard blow, whose peak has the power of ten of the largest force of its joint.
  Fewest fewest() const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive.doubles(self.joints_);
  }

 private:
  enum class Phase { apart, rises, falls, over };
  struct OfJoint {  // doubles alone
    double joint = 0.0, phase = 0.0, steps = 0.0, peak = 0.0, low = 0.0;
    double largest = 0.0;       ///< force in all [N]
    double fewest = unbounded;  ///< steps of a blow
    double hardest = 0.0;       ///< and its peak [N]
  };

  std::vector<OfJoint> joints_;  // with play
};

}  // namespace freeplay
