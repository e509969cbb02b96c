// WholeFile: writes a file that is there complete or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace freeplay {

/// Writes under a temporary name beside `given` and renames it; a link stays and its file is replaced, a terminal or
/// pipe is written to. `safe`: it is on the disk on return. Makes the folder. Throws Error{file} "cannot-write".
void write_whole_file(const std::filesystem::path& given, std::string_view text, bool safe = false);

/// Where a file is written first that is to be complete or not at all: ".NAME.part" beside it.
std::filesystem::path part_of(const std::filesystem::path& path);

/// Tells the disk of a new name in the folder of `path`. Throws Error{file} "cannot-write".
void sync_folder_of(const std::filesystem::path& path);

}  // namespace freeplay
