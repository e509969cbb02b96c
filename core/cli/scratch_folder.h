// new_scratch_folder: a folder for files that are not kept.
#pragma once

#include <filesystem>

namespace freeplay {

/// A new, empty folder among the system's temporary files; the caller removes it. Throws Error{file} "cannot-write".
std::filesystem::path new_scratch_folder();

}  // namespace freeplay
