// What a joint must have left in the numbers that it was given to fill. Words are written in place: nothing allocates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "freeplay/joint.h"

namespace freeplay {

/// Index of the first number that is not finite; numbers.size when all are.
inline std::size_t first_wild(Span<const double> numbers) {
  return static_cast<std::size_t>(
      std::find_if_not(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }) - numbers.begin());
}

/// Are history and internal variables finite after the call named `call`? If not, `message` says which is not.
inline bool keeps_finite(Span<const double> internal, Span<const double> history, const char* call, Message& message) {
  const std::size_t z = first_wild(internal), h = first_wild(history);
  if (z == internal.size && h == history.size) return true;
  const bool of_history = h < history.size;
  std::snprintf(message.text, sizeof message.text, "number %zu of its %s is not finite after %s()",
                (of_history ? h : z) + 1, of_history ? "history" : "internal variables", call);
  return false;
}

}  // namespace freeplay
