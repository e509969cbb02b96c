// PoseForm: the numbers that the pose of a frame is written in, in the plane and in space.
#pragma once

#include <array>
#include <span>
#include <string>

#include "model/model.h"

namespace freeplay {

inline constexpr std::size_t most_components = 6;
/// A pose of the platform's frame in world axes, as PoseForm says; 0 beyond its size.
using FramePose = std::array<double, most_components>;
/// Which numbers of a pose are meant; none beyond the form's size.
using Components = std::array<bool, most_components>;

inline int count(const Components& components) {
  int given = 0;
  for (const bool component : components) given += component ? 1 : 0;
  return given;
}

/// In the plane x, y [m] and angle [rad]; in space x, y, z [m] and roll, pitch, yaw [rad], turns about the fixed x,
/// then y, then z axis. Small changes dX of a pose are shifts in the order of the lengths, then the rotation vector:
/// the angle in the plane, its three components along the world's axes in space.
struct PoseForm {
  std::span<const char* const> words;    ///< of the numbers
  std::span<const char* const> changes;  ///< of the components of dX
  std::span<const int> twist;            ///< place of each component of dX in a twist
  std::span<const char* const> forces;   ///< of a wrench, those that are shown
  std::size_t lengths = 0;               ///< so many lengths stand first, the others are angles

  std::size_t size() const { return words.size(); }
  int freedoms() const { return static_cast<int>(words.size()); }
  bool is_turn(std::size_t component) const { return component >= lengths; }
  Components all() const;
};
const PoseForm& pose_form(Space space);

/// Do the given numbers hold all angles or none? Changes of single angles in space are no changes of a rotation vector.
bool turns_whole(const PoseForm& form, const Components& given);

/// "x, y and angle"
std::string enumeration(std::span<const char* const> words);

}  // namespace freeplay
