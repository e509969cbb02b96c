// TableRows: the rows of a study's table, one after the other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace freeplay {

class TableRows {
 public:
  /// Throws Error{input} "file-not-found" where the folder has no study.csv.
  explicit TableRows(const std::filesystem::path& folder);

  const std::vector<std::string>& columns() const { return columns_; }
  /// The next whole row; false at the end.
  bool next();
  /// What stands at a place of the file that place() has named.
  bool read(std::uint64_t place);
  /// Where the row in hand begins [bytes].
  std::uint64_t place() const { return place_; }
  const std::vector<std::string_view>& cells() const { return cells_; }
  std::uint64_t index() const;

 private:
  std::ifstream file_;
  std::vector<std::string> columns_;
  std::string line_;
  std::vector<std::string_view> cells_;  // of line_
  std::uint64_t place_ = 0, after_ = 0;
};

/// Of a line without quotes.
void split_cells(std::string_view line, std::vector<std::string_view>& cells);
/// NaN for what is no number.
double number_of_cell(std::string_view cell);

}  // namespace freeplay
