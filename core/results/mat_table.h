// MatTable: a table that was exported as a MAT-file, read back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace freeplay {

struct MatTable {
  std::vector<std::string> channels, units;
  std::vector<double> time, data;  ///< `data` column after column
  std::string provenance;          ///< JSON
};

/// Throws Error{file} "unreadable-result".
MatTable read_mat(const std::filesystem::path& path);

}  // namespace freeplay
