// Grid: several values of one quantity, as `analysis` and `sweep` write them.
#pragma once

#include <optional>
#include <vector>

#include "model/checked_value.h"

namespace freeplay {

inline constexpr long largest_grid = 100'000'000;  ///< points

/// Checks a grid of `dimension`, or of whatever one dimension all its points have. Returns the number of points,
/// nothing after an error.
std::optional<long> check_grid(const CheckedValue& value, std::optional<Dimension> dimension);

}  // namespace freeplay
