// Grid: several values of one quantity, as `analysis` and `study` write them.
#pragma once

#include <optional>
#include <vector>

#include "format/checked_value.h"
#include "model/grid_values.h"

namespace freeplay {

inline constexpr long largest_grid = 100'000'000;  ///< points

/// A grid of whatever dimension, or of `dimension` if that is given; else it becomes that of the first point that has
/// one. Nothing after an error.
std::optional<GridValues> read_grid(const CheckedValue& value, std::optional<Dimension>& dimension);
/// `[from, to, count]`.
std::optional<GridValues> read_space(const CheckedValue& value, bool logarithmic, std::optional<Dimension>& dimension);

}  // namespace freeplay
