// study_reproduction: a study's table, pictures and page made again and compared.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cli/options.h"
#include "results/made_file.h"

namespace freeplay {

/// The directory of the study that a path is, or is a table, a picture or the page of; nothing where it is none.
std::optional<std::filesystem::path> study_of(const std::filesystem::path& path);

/// Of the directory or a table all points are run again from the copies in it, and every byte is compared; a picture or
/// the page is drawn again from the table that is there. `out` keeps what was made. Returns the exit code. Throws
/// Error.
int reproduce_study(const std::filesystem::path& path, const std::filesystem::path& out, const CommonOptions& common);

/// The same for a table that `export` has made of a study, whose points are run from the texts in its record.
int reproduce_study_table(const MadeFile& made, const std::filesystem::path& out, const CommonOptions& common);

}  // namespace freeplay
