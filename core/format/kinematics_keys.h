// Keys that an inverse-kinematics driver and the section `analysis` share.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "format/map_reader.h"

namespace freeplay {

/// x, y [m] and angle [rad] of a frame as functions of time; what is left out is empty. Reports `missing-key` when all
/// are. Nothing after an error.
std::optional<std::array<std::optional<Expression>, 3>> read_path(const CheckedValue& value);

/// Working modes 1 or -1 of `count` joints, from one number or a list. Without `count` any list will do.
std::optional<std::vector<int>> read_elbow(const CheckedValue& value, std::optional<std::size_t> count);

}  // namespace freeplay
