// Rotations in space.
#pragma once

#include "model/model.h"

namespace freeplay {

/// a b.
Rotation product(const Rotation& a, const Rotation& b);

/// R_z(yaw) R_y(pitch) R_x(roll), angles [rad].
Rotation from_roll_pitch_yaw(double roll, double pitch, double yaw);

/// The least rotation that takes the unit vector `from` to the unit vector `to`; half a turn about a fixed axis where
/// they are opposite.
Rotation least_rotation(const Vector3& from, const Vector3& to);

/// Eigenvalues of a symmetric tensor, the least first.
Vector3 principal_moments(const Rotation& tensor);

}  // namespace freeplay
