// PlayLaw: how play and errors of inputs are distributed within their bounds.
#pragma once

#include <span>

#include "analysis/play_hull.h"
#include "analysis/random_draws.h"

namespace freeplay {

/// Of one play in shares of its clearance (1, 2 or 3 numbers in the unit segment, disc or ball), of one input in shares
/// of its error (a number in [-1, 1]). All are independent, but for the closure of a redundant mechanism.
struct PlayLaw {
  enum class Kind {
    uniform,  ///< over the ball, the disc, the interval
    rim,      ///< every pin touches its bearing: uniform on the sphere or circle; intervals are filled uniformly
    normal,   ///< every number normal with standard deviation `sigma`, cut off at the ball, the disc, the interval's
              ///< ends
  };
  Kind kind = Kind::uniform;
  double sigma = 1.0 / 3.0;  ///< of `normal`, greater than 0
};

/// Variance of each of the numbers, `size` 1 (interval), 2 (disc) or 3 (ball), in closed form.
double variance(const PlayLaw& law, int size);

/// Draws one play (1, 2 or 3 numbers) or input (1 number) by itself.
void draw(const PlayLaw& law, RandomDraws& random, std::span<double> out);

/// Draws one play between flat bounds, in shares of its hull: uniform in it; for `rim` in any direction as far as it
/// goes; for `normal` every number, given that they lie in it.
void draw(const PlayLaw& law, RandomDraws& random, const PlayHull& hull, std::span<double> out);

}  // namespace freeplay
