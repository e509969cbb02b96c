// PlayLaw: how play and errors of inputs are distributed within their bounds.
#pragma once

#include <span>

#include "analysis/random_draws.h"

namespace freeplay {

/// Of one play in shares of its clearance (2 numbers in the unit disc), of one input in shares of its error (a number
/// in [-1, 1]). All are independent, but for the closure of a redundant mechanism.
struct PlayLaw {
  enum class Kind {
    uniform,  ///< over the disc, over the interval
    rim,      ///< every pin touches its bearing: uniform on the circle; inputs uniform over their interval
    normal,   ///< every number normal with standard deviation `sigma`, cut off at the disc and at the interval's ends
  };
  Kind kind = Kind::uniform;
  double sigma = 1.0 / 3.0;  ///< of `normal`, greater than 0
};

/// Variance of each of the numbers, `size` 2 (disc) or 1 (interval), in closed form.
double variance(const PlayLaw& law, int size);

/// Draws one play (2 numbers) or input (1 number) by itself.
void draw(const PlayLaw& law, RandomDraws& random, std::span<double> out);

}  // namespace freeplay
