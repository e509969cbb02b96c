// Fields of a line of text that a separator divides.
#pragma once

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>

namespace freeplay {

/// NaN for an empty field.
inline double number_in(std::string_view field) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(field.data(), field.data() + field.size(), value);
  return value;
}

/// The text before the first separator, or all; it and the separator are taken off `rest`.
inline std::string_view cut_field(std::string_view& rest, char separator) {
  const std::size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view field = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return field;
}

}  // namespace freeplay
