// format_into: text by fmt into characters that are there already, as faults of a step need it: nothing is allocated.
#pragma once

#include <fmt/core.h>

namespace freeplay {

/// Its template stands once in the program, where each use of fmt::format_to_n would bring 100 kB of its own.
char* put_into(char* to, const char* end, fmt::string_view text, fmt::format_args values) noexcept;

/// Writes as much as finds room in [to, end), without a zero at its end; returns one past the last character.
template <class... Values>
char* format_into(char* to, const char* end, fmt::format_string<const Values&...> text,
                  const Values&... values) noexcept {
  return put_into(to, end, text, fmt::make_format_args(values...));
}

}  // namespace freeplay
