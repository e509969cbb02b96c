// shell_word: a word of a command that people type or copy.
#pragma once

#include <string>
#include <string_view>

namespace freeplay {

/// The word as a POSIX shell reads it back: in single quotes, unless none of its characters means anything to a shell.
std::string shell_word(std::string_view word);

}  // namespace freeplay
