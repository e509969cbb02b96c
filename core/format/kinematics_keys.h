// Keys that an inverse-kinematics driver and the section `analysis` share.
#pragma once

#include <optional>
#include <vector>

#include "format/draft.h"

namespace freeplay {

/// Numbers of a frame's pose as functions of time or from a file of poses; what is left out is empty. Reports
/// `missing-key` when all are. Nothing after an error. `in_run`: whether its time is that of the run.
std::optional<FramePath> read_path(Draft& draft, const CheckedValue& value, bool in_run);

/// Working modes 1 or -1 of `count` joints, from one number or a list. Without `count` any list will do.
std::optional<std::vector<int>> read_elbow(const CheckedValue& value, std::optional<std::size_t> count);

}  // namespace freeplay
