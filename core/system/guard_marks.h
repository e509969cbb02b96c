// GuardMarks: numbers after an array that a plugin fills, so that a write a little past its end is seen and harms
// nothing.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace freeplay::guard {

/// How many marks stand after an array.
inline constexpr std::size_t marks = 4;

/// A number that no model makes.
inline double mark() { return std::bit_cast<double>(std::uint64_t{0x4337c0ffee15600d}); }

/// `end` is the first number after the array; `marks` numbers from there are ours.
inline void set(double* end) {
  for (std::size_t i = 0; i < marks; ++i) end[i] = mark();
}
inline bool intact(const double* end) {
  bool same = true;
  for (std::size_t i = 0; i < marks; ++i) {
    same = same && std::bit_cast<std::uint64_t>(end[i]) == std::bit_cast<std::uint64_t>(mark());
  }
  return same;
}

}  // namespace freeplay::guard
