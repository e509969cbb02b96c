// PitchRadii: the circles of a gear pair that roll on each other.
#pragma once

#include <cmath>

#include "model/model.h"

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

/// The ratio of the wheels against the body that carries both: a joint of which that body is the second counts the
/// other way than one of which it is the first.
inline double ratio_of_wheels(const Model& model, const Gear& gear) {
  const JointElement &first = model.joints[static_cast<std::size_t>(gear.first)],
                     &second = model.joints[static_cast<std::size_t>(gear.second)];
  if (first.gear >= 0 || second.gear >= 0) return gear.ratio;
  const auto body = [&](int marker) { return model.markers[static_cast<std::size_t>(marker)].body; };
  const bool crossed = body(first.marker_a) == body(second.marker_b) || body(first.marker_b) == body(second.marker_a);
  const bool alike = body(first.marker_a) == body(second.marker_a) || body(first.marker_b) == body(second.marker_b);
  return crossed && !alike ? -gear.ratio : gear.ratio;
}

}  // namespace freeplay
