// Numbers that lie evenly between -1 and 1, by which guesses are turned: each by another one, and the same in each run.
#pragma once

#include <cmath>
#include <vector>

#include "base/index.h"
#include "system/system.h"

namespace freeplay {

/// The `count`-th of them; `seed`: of other such rows. Multiples of two irrational numbers.
inline double even_spread(int count, int seed = 0) {
  const double share = count * 0.6180339887498949 + seed * 0.7548776662466927;
  return 2.0 * (share - std::floor(share)) - 1.0;
}

/// An increment of the positions of `system` by which each body turns by another angle, up to `most` [rad].
inline std::vector<double> spread_turns(const System& system, double most, int seed = 0) {
  std::vector<double> increment(at(system.layout().nv()), 0.0);
  for (int i = 0, turned = 0; i < static_cast<int>(increment.size()); ++i) {
    if (system.coordinates().is_turn(i)) increment[at(i)] = most * even_spread(++turned, seed);
  }
  return increment;
}

}  // namespace freeplay
