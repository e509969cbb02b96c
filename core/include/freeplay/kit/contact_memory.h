// What friction remembers of one contact.
#pragma once

#include <array>
#include <cstddef>

#include "freeplay/span.h"

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

}  // namespace freeplay::play
