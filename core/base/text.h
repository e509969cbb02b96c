// Text: characters of UTF-8 input, and text that is safe to print.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace freeplay {

/// Bytes of the character that begins at byte `position`: 1 to 4, or 0 if no valid UTF-8 character begins there
/// (overlong forms, surrogates and values above U+10FFFF are invalid).
std::size_t character_bytes(std::string_view text, std::size_t position);

/// Number of characters. A byte that belongs to no valid character counts as one.
int character_count(std::string_view text);

/// Columns that a terminal takes for a printable text: two for a wide character (Chinese, Japanese, Korean, emoji),
/// none for one that is put on the character before it, else one. Unicode 15, EastAsianWidth.txt, by blocks.
int display_width(std::string_view text);

/// Makes each carriage return that stands alone a line feed. No byte moves.
void end_lines_by_line_feeds(std::string& text);

/// The text with each control character (C0, DEL, C1, line and paragraph separators), direction override, code
/// that is no character and invalid byte replaced by one '?', and each tab by one blank. The number of characters stays
/// the same.
std::string printable(std::string_view text);

}  // namespace freeplay
