// FastMotion: how many steps of one size the fastest motion that carries energy has in a period.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "system/system.h"

namespace freeplay {

/// From one step to the next the acceleration of a motion of circular frequency w changes by the part 2 sin(w h/2) of
/// what it is, in the mean, and its speed is the acceleration by w. Of each free body both are summed up in sixteen
/// parts of the run, weighed by its mass: what is fastest has the largest accelerations.
class FastMotion {
 public:
  explicit FastMotion(const System& system);

  /// A step of the length dt that ends at t, with the accelerations of the unknowns at both ends and their velocities
  /// at the end.
  void add(double t, double dt, std::span<const double> start, std::span<const double> end, std::span<const double> v);

  struct Fewest {
    double steps = unbounded;  ///< in a period
    int body = -1;
    double energy = 0.0;  ///< that its motion carries, in the mean [J]
  };
  /// The fewest steps that a motion takes which carries more than a hundredth of the largest mean kinetic energy of a
  /// part of the run.
  Fewest fewest() const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.counts_);
    archive.doubles(self.sums_);
  }

 private:
  static constexpr std::size_t parts = 16;
  struct Sums {            // of a body in a part of the run, by mass [J]
    double kinetic = 0.0;  ///< v^2
    double change = 0.0;   ///< (h a)^2
    double turn = 0.0;     ///< (h (a - a_before))^2
  };

  const System& system_;
  std::size_t bodies_;
  std::vector<long> counts_;  ///< of steps, by part
  std::vector<Sums> sums_;    ///< by part and free body
};

}  // namespace freeplay
