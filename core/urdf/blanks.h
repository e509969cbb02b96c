// Blanks: what XML takes for space between words.
#pragma once

#include <string_view>

namespace freeplay {

inline constexpr std::string_view blanks = " \t\r\n";

}  // namespace freeplay
