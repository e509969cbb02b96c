// Paths from a CSV file of poses.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Reads the keys of a path that name a file, from the map of the path or from the name of the file alone. The columns
/// are known by their names: time, or the one that `time` names, then x, y and angle in the plane, or x, y, z and the
/// quaternion qw, qx, qy, qz in space, turned from the frame's axes to the world's. Columns that are not there leave
/// their numbers open; a quaternion has all four, and rows whose length is not 1 to 1e-3 are refused, as are
/// neighbours more than 170 deg apart, between which the way is not certain. Nothing after an error.
std::optional<FramePath> read_pose_table(Draft& draft, const CheckedValue& value, MapReader& map);

}  // namespace freeplay
