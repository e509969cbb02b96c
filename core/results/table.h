// ResultTable: the rows of a result, read back.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freeplay {

/// Columns of numbers over time; an empty field is NaN.
struct ResultTable {
  std::string file;                         ///< what was read, for messages
  std::vector<std::string> names;           ///< of the columns; the first is "time"
  std::vector<std::vector<double>> values;  ///< by column, all of one length

  const std::vector<double>& time() const { return values.front(); }
  /// Index of a column, or -1.
  int find(std::string_view name) const;
};

/// Reads time and the channels that fit a pattern from a result directory, a CSV or an HDF5 file; others are not read.
/// Throws Error{file} "unreadable-result" that says why: it is not there, has no column `time`, a field that is no
/// number, a row of another length, times that do not grow.
ResultTable read_result(const std::filesystem::path& path, std::span<const std::string> patterns);

}  // namespace freeplay
