// Compact: sources of a page without what only those who write them need.
#pragma once

#include <string>
#include <string_view>

namespace freeplay {

/// Where blanks and line feeds mean nothing.
struct Syntax {
  std::string_view marks;  ///< blanks beside one of these, outside of strings
  std::string_view ends;   ///< line feeds after one of these
};

inline constexpr Syntax script_syntax{"{}()[];,:=<>+-*/?&|!", "{;,("}, style_syntax{"{}:;,", "{};,"},
    html_syntax{"", ">"};

/// Leaves out lines of comment, indents, blanks and line feeds that mean nothing, and, where `}` is a mark, `;` and
/// line feeds before it. In what it is given no regular expression has a quote or a blank, no string a line feed, and
/// no statement is empty.
std::string compact(std::string_view source, const Syntax& syntax);

}  // namespace freeplay
