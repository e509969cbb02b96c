// Seal: makes the result of a killed run an ordinary one.
#pragma once

#include <cstdint>
#include <filesystem>

namespace freeplay {

struct Sealed {
  bool changed = false;  ///< false: there was nothing to do
  std::int64_t rows = 0;
  double time = 0.0;  ///< of the last row [s]
};

/// Copies the complete rows of results.h5 into a file that any reader opens, cuts unfinished lines off text files and
/// writes a summary where there is none; the same of its twin. Throws Error{file} "unreadable-result" where `directory`
/// is no result, "result-in-use", "cannot-write" with the files as they were.
Sealed seal_result(const std::filesystem::path& directory);

}  // namespace freeplay
