// point_message: why a point failed, in the same words wherever its files lie.
#pragma once

#include <span>
#include <string>

namespace freeplay {

/// One line without control characters. Of a path in quotes that is absolute, or leads into one of `folders`, the name
/// of the file alone is left: rows of two machines are to be the same bytes.
std::string point_message(const std::string& text, std::span<const std::string> folders);

}  // namespace freeplay
