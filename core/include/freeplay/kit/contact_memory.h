// What friction remembers of one contact.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "freeplay/friction_law.h"

namespace freeplay::play {

/// Internal variables, `most` at most, less what they were when the last contact ended: not every end is marked by an
/// event that could clear them.
template <std::size_t most>
struct MemoryOf {
  MemoryOf(Span<const double> internal, Span<const double> forgotten) : size(internal.size) {
    for (std::size_t i = 0; i < size; ++i) z[i] = internal[i] - forgotten[i];
  }
  operator Span<const double>() const { return {z, size}; }
  template <class T>
  std::array<T, most> numbers() const {
    std::array<T, most> out;
    for (std::size_t i = 0; i < size; ++i) out[i] = T(z[i]);
    return out;
  }
  double z[most];
  std::size_t size;
};

/// What a law of friction declares of its internal variables, `most` at most.
template <std::size_t most>
struct MemoryRules {
  MemoryRules() = default;
  /// The law has no more than `most` of them.
  explicit MemoryRules(const FrictionLawRef& law)
      : size(static_cast<std::size_t>(std::max(law.internal_variables(), 0))) {
    law.memory({start, size}, {resets, size});
  }
  bool forgets(std::size_t k) const { return resets[k] == MemoryReset::each_contact; }
  /// Whether a variable is what a deflection is: zero at first, and forgotten.
  bool is_deflection(std::size_t k) const { return start[k] == 0.0 && forgets(k); }
  double start[most]{};
  MemoryReset resets[most]{};
  std::size_t size = 0;
};

}  // namespace freeplay::play
