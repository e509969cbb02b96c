// WholeFile: writes a file that is there complete or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace freeplay {

/// Writes under a temporary name beside `given` and renames it; a link stays and its file is replaced, a terminal or
/// pipe is written to. Makes the folder. Throws Error{file} "cannot-write".
void write_whole_file(const std::filesystem::path& given, std::string_view text);

}  // namespace freeplay
