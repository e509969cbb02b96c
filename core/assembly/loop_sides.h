// A loop of pins whose sides are too short or too long to close.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/model.h"

namespace freeplay {

/// A loop of joints that hold two points together each, in which one side is longer than the others together.
struct OverlongLoop {
  std::vector<int> joints;  ///< indices into Model::joints, in the order of the loop
  /// "'crank' 0.05 m, 'rod' 0.12 m and ground 0.5 m, and that of ground is longer than the others together (joints 'A',
  /// 'B' and 'C')": from joint to joint on each body.
  std::string text;
  bool one_side = false;  ///< then without "and that of ...": its other bodies have both joints at one place
};

/// The one with the fewest sides, of those through a joint or of all (-1), of at most 12 joints; where a mechanism has
/// very many, of those that were tried. Empty where each of them can close.
std::optional<OverlongLoop> overlong_loop(const Model& model, int joint);

/// "'a', 'b' and 'c'".
std::string enumerated(const std::vector<std::string>& words);

}  // namespace freeplay
