// UnitPrefix: a unit with the prefix that suits a number.
#pragma once

#include <string>
#include <string_view>

namespace freeplay {

struct PrefixedUnit {
  double factor = 1.0;  ///< value in the unit without prefix = value in this one * factor
  std::string unit;
};

/// The unit with the prefix (n, u, m, k, M, G) that leaves one to three digits before the point of `value`, or without
/// one where none does.
PrefixedUnit prefixed_unit(double value, std::string_view unit);

}  // namespace freeplay
