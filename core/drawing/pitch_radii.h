// PitchRadii: the circles of a gear pair that roll on each other.
#pragma once

#include <cmath>

namespace freeplay {

struct PitchRadii {
  double first, second;
};

/// Of parallel axes so far apart. Teeth of both wheels pass equally fast, so that r_1 = |ratio| r_2; the wheels lie
/// outside of each other where they turn against each other, as a negative ratio says.
inline PitchRadii pitch_radii(double distance, double ratio) {
  const double second = distance / std::abs(1.0 - ratio);
  return {second * std::abs(ratio), second};
}

}  // namespace freeplay
