// PathPose: where a path wants a frame to be, with rates and accelerations.
#pragma once

#include <array>
#include <span>

#include "base/jet.h"
#include "model/model.h"

namespace freeplay {

/// The numbers of a pose in model files, in the order of FramePath.
std::span<const char* const> path_words(Space space);
inline std::size_t path_numbers(Space space) { return space == Space::spatial ? 6 : 3; }

/// Orientation of a frame in space, its angular velocity [rad/s] and angular acceleration [rad/s^2], world axes.
struct Turning {
  Rotation rotation = no_rotation;
  Vector3 velocity{}, acceleration{};
};

/// In the plane x, y [m] and the angle [rad]; in space x, y, z [m] and roll, pitch, yaw [rad], turns about the fixed x,
/// then y, then z axis.
struct PathPose {
  std::array<Jet, most_path_numbers> numbers{};
  Turning turning{};  ///< in space, the whole orientation

  Jet& operator[](std::size_t number) { return numbers[number]; }
  const Jet& operator[](std::size_t number) const { return numbers[number]; }
};

/// Of the unit quaternion p = q/|q| for q = (w, x, y, z) other than zero: the rotation of p, and in world axes
///
///   omega = 2 p' p*,   alpha = 2 p'' p*,
///
/// whose scalar parts are left out: that of p' p* is zero, and p' p'* is a scalar, which drops out of the derivative of
/// omega.
Turning turning_of(const std::array<Jet, 4>& q);

/// Of R_z(yaw) R_y(pitch) R_x(roll), by the product of three quaternions.
Turning turning_of(const Jet& roll, const Jet& pitch, const Jet& yaw);

/// roll, pitch, yaw of an orientation with their derivatives. These are not finite where the pitch is a quarter turn.
std::array<Jet, 3> roll_pitch_yaw_of(const Turning& turning);

}  // namespace freeplay
