// TableColumns: some columns of a table that a study has written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace freeplay {

class TableColumns {
 public:
  /// Reads study.csv or samples.csv. Throws Error{input} "file-not-found" for the file, "unknown-name" for a column.
  TableColumns(const std::filesystem::path& file, std::span<const std::string> names);

  std::size_t rows() const { return rows_; }
  const std::vector<std::string>& words(const std::string& name) const;
  /// NaN for what is no number.
  std::vector<double> numbers(const std::string& name) const;

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> cells_;  // by column
  std::size_t rows_ = 0;
};

}  // namespace freeplay
