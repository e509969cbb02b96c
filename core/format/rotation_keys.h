// Rotations and axes as model files give them.
#pragma once

#include <optional>

#include "format/map_reader.h"
#include "model/model.h"

namespace freeplay {

/// The keys `rpy` and `quaternion` (w, x, y, z; made a unit one, with a warning) of a pose or frame; refused in planar
/// models. Reports what is wrong.
std::optional<Rotation> read_rotation(MapReader& map);

/// A direction, made a unit vector, with the warning `not-unit` if it was none. Reports `out-of-range` for one without
/// length.
std::optional<Vector3> read_axis(const CheckedValue& value);

}  // namespace freeplay
