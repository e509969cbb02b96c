// SlipWatch: friction that is smoothed over a speed which nothing comes near.
#pragma once

#include <vector>

#include "model/channel.h"
#include "system/system.h"

namespace freeplay {

struct RunContext;

/// A law that smooths the change of sign over the speed `vs` has tanh(0.1), a tenth of its friction, at a tenth of
/// `vs`. Where a run slips no faster than that, `vs` is in other units than meant, and there is hardly any friction.
/// Speeds over which one smooths on purpose are not watched: what rests there creeps.
class SlipWatch {
 public:
  [[gnu::cold]] SlipWatch(const System& system, const Channels& channels);

  /// A row that is written, evaluated in `e`.
  void add(std::span<const double> row, const Evaluation& e);
  /// Once the run is over: the doubt `law-range` of each.
  [[gnu::cold]] void say(RunContext& run) const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    for (auto& one : self.slidings_) archive(one.fastest);
  }

 private:
  static constexpr double reached = 0.1;                  ///< part of vs below which there is hardly any friction
  static constexpr double watched = 0.01, turning = 0.3;  ///< smaller ones are not looked at [m/s], [rad/s]
  struct Sliding {
    int joint;
    int slip = -1, normal_force = -1;  ///< columns; -1: the speed is that of its coordinate, and it always presses
    bool turns = false;
    double vs = 0.0, fastest = 0.0;
  };
  std::vector<Sliding> slidings_;
};

}  // namespace freeplay
