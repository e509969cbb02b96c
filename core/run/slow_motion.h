// SlowMotion: the longest period in which what moves by itself comes and goes.
#pragma once

#include <span>
#include <vector>

#include "run/outcome.h"
#include "system/system.h"

namespace freeplay {

/// Each velocity of a free body turns its sign twice in a period: the last three times say how long that is. Before the
/// first of them a rest counts as one, as where a pendulum is let go.
class SlowMotion {
 public:
  [[gnu::cold]] explicit SlowMotion(const System& system);  // these by size: few runs look for a period

  /// A step from t - dt to t, with the velocities of the unknowns at its ends.
  [[gnu::cold]] void add(double t, double dt, std::span<const double> start, std::span<const double> end);

  /// Of what still moves at t, with these velocities and accelerations: not what died out, nor what carried less than a
  /// hundredth of the energy.
  [[gnu::cold]] Swing slowest(double t, std::span<const double> v, std::span<const double> a) const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive.doubles(self.turns_);
  }

 private:
  struct Turns {  // of one velocity
    double sign = 0.0, largest = 0.0;
    double times[3] = {-unbounded, -unbounded, -unbounded};  ///< the last one first [s]
  };

  const System& system_;
  std::vector<Turns> turns_;
};

}  // namespace freeplay
