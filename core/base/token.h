// Token: the lexical elements that expressions and units share. Positions are bytes.
#pragma once

#include <cstddef>
#include <string_view>

namespace freeplay {

/// First position at or after `position` that is not white space.
std::size_t skip_blanks(std::string_view text, std::size_t position);

/// End of the word (letters, digits, '_', letters outside ASCII) that begins at `position`; `position` if none does.
std::size_t word_end(std::string_view text, std::size_t position);

/// End of the decimal number that begins at `position`, without a sign; `position` if none does.
std::size_t number_end(std::string_view text, std::size_t position);

/// Value of a number delimited by number_end(), whatever the locale; infinity if it is too large, 0 if too small.
double number_value(std::string_view number);

}  // namespace freeplay
