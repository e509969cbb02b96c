// A model file that is written to another folder than the one it was read from.
#pragma once

#include <filesystem>

#include "format/document.h"

namespace freeplay {

/// A copy of the tree in which the relative paths of tables and plugins, which count from the folder of the model file,
/// are changed from folder `from` to folder `to`. Absolute paths and names of plugins stay.
Document moved_model(const Document& document, const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace freeplay
