// WholeText: a text through a file descriptor, whatever interrupts.
#pragma once

#include <string>
#include <string_view>

namespace freeplay {

/// False where not all could be written.
bool write_all(int file, std::string_view text);
/// From the beginning of a file to its end, or to where it cannot be read.
std::string read_all(int file);

}  // namespace freeplay
