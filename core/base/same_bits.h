#pragma once

#include <cstring>
#include <span>

namespace freeplay {

/// Whether two lists of numbers are equal bit for bit, so that NaN equals itself and 0 differs from -0.
inline bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

}  // namespace freeplay
