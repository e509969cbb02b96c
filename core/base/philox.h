// Philox: random numbers that are drawn by their place, not from a stream.
#pragma once

#include <array>
#include <cstdint>

namespace freeplay {

using RandomWords = std::array<std::uint64_t, 4>;

/// Philox4x64-10 of Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC11 (2011): four
/// words for each key and counter, the same on every machine and in any order.
inline RandomWords philox(RandomWords counter, std::array<std::uint64_t, 2> key) {
  __extension__ using Product = unsigned __int128;
  for (int round = 0; round < 10; ++round) {
    const Product a = Product{0xD2E7470EE14C6C93u} * counter[0], b = Product{0xCA5A826395121157u} * counter[2];
    counter = {static_cast<std::uint64_t>(b >> 64) ^ counter[1] ^ key[0], static_cast<std::uint64_t>(b),
               static_cast<std::uint64_t>(a >> 64) ^ counter[3] ^ key[1], static_cast<std::uint64_t>(a)};
    key[0] += 0x9E3779B97F4A7C15u;
    key[1] += 0xBB67AE8584CAA73Bu;
  }
  return counter;
}

/// A word as a number strictly between 0 and 1.
inline double unit_number(std::uint64_t word) { return (static_cast<double>(word >> 12) + 0.5) * 0x1p-52; }

}  // namespace freeplay
