// RandomNumbers: a generator whose numbers are the same everywhere; those of the standard library are not.
#pragma once

#include <cstdint>

namespace freeplay {

/// SplitMix64 (Steele, Lea and Flood 2014).
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}

  /// Uniform in [low, high).
  double between(double low, double high) { return low + (high - low) * 0x1p-53 * static_cast<double>(next() >> 11); }

 private:
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t x = state_;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
  }
  std::uint64_t state_;
};

}  // namespace freeplay
