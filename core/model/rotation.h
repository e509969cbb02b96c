// Rotations in space as model files give them.
#pragma once

#include <optional>

#include "model/map_reader.h"

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

/// The keys `rpy` and `quaternion` (w, x, y, z; made a unit one, with a warning) of a pose or frame; refused in planar
/// models. Reports what is wrong.
std::optional<Rotation> read_rotation(MapReader& map);

/// A direction, made a unit vector, with the warning `not-unit` if it was none. Reports `out-of-range` for one without
/// length.
std::optional<Vector3> read_axis(const CheckedValue& value);

}  // namespace freeplay
