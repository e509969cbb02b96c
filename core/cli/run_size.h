// RunSize: a run that will write much says so first, and asks where that is much of the disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "cli/run_options.h"
#include "model/model.h"

namespace freeplay {

/// Rows of so many columns that results.h5 would take over half a gigabyte of memory go to results.csv alone where
/// neither the file nor an option gives the format. Prints and returns a sentence that says so.
std::string settle_format(Model& model, const RunOptions& options, const CommonOptions& common);

/// Prints how much will be written where that is 1 GB or more. `rows_there`: of a result that goes on. Throws
/// Error{file} "too-large" where it is more than half of the room that there is, unless --yes was given.
void announce_size(const Model& model, const std::filesystem::path& directory, std::int64_t rows_there,
                   const RunOptions& options, const CommonOptions& common);

}  // namespace freeplay
