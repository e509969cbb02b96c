// Range: bounds of a number, each end open or closed.
#pragma once

#include <string>

#include "freeplay/parameter.h"

namespace freeplay {

struct Range {
  double minimum = -unbounded, maximum = unbounded;
  Open open = Open::none;

  bool contains(double x) const;
  /// Such as "> 0 kg" or ">= 0 and < 0.5"; `unit` "1" is left out. Empty for an unbounded range.
  std::string text(const std::string& unit) const;
};

inline constexpr Range positive{.minimum = 0.0, .open = Open::minimum};
inline constexpr Range not_negative{.minimum = 0.0};

/// The number in its shortest form, with the unit unless that is "1".
std::string with_unit(double value, const std::string& unit);

}  // namespace freeplay
