// Base64: numbers as text, little-endian, for JSON.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace freeplay {

std::string base64(std::string_view bytes);

/// Characters that so many bytes take.
constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

template <class Number>
std::string base64_numbers(std::span<const Number> numbers) {
  static_assert(std::endian::native == std::endian::little);
  return base64({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
}

/// Differences from `offset`, in single precision; NaN where they are infinite in it.
std::string base64_floats(std::span<const double> numbers, double offset = 0.0);

}  // namespace freeplay
