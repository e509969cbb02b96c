#include "report/base64.h"

#include <cmath>
#include <limits>
#include <vector>

namespace freeplay {

std::string base64(std::string_view bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(base64_size(bytes.size()));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> unsigned {
      return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u;
    };
    const unsigned group = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k > 0 && i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63u];
    }
  }
  return text;
}

std::string base64_floats(std::span<const double> numbers, double offset) {
  std::vector<float> floats(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    floats[i] = static_cast<float>(numbers[i] - offset);
    if (!std::isfinite(floats[i])) floats[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return base64_numbers<float>(floats);
}

}  // namespace freeplay
