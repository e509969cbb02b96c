// Compact: sources of a page without what only those who write them need.
#pragma once

#include <string>
#include <string_view>

namespace freeplay {

/// Leaves out lines of comment, indents, and blanks beside the characters `marks` outside of strings, except between
/// two `+` or two `-`; a line goes on with the next where it ends in one of `{;,(`. In what it is given no regular
/// expression has a quote or a blank, and no string a line feed.
std::string compact(std::string_view source, std::string_view marks);

inline constexpr std::string_view script_marks = "{}()[];,:=<>+-*/?&|!", style_marks = "{}:;,";

}  // namespace freeplay
