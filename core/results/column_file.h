// ColumnFile: tables as HDF5 that netCDF-4 reads too, the same bytes for the same numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "results/record.h"

namespace freeplay {

/// First declare dimensions and columns, then put rows. Throws Error{file} "cannot-write"; nothing may be called after
/// that.
class ColumnFile {
 public:
  enum class Kind { number, whole, words };

  ColumnFile(std::filesystem::path path, const std::vector<std::pair<std::string, std::string>>& attributes);
  ~ColumnFile();
  ColumnFile(const ColumnFile&) = delete;
  ColumnFile& operator=(const ColumnFile&) = delete;

  /// `most`: rows that there can be.
  std::size_t add_dimension(const std::string& name, std::uint64_t most);
  /// Columns of a dimension stand in the file in this order. `sample_dimension` is of row sizes, for readers of ragged
  /// arrays (CF conventions); may be empty.
  std::size_t add_column(std::size_t dimension, const RecordColumn& column, Kind kind,
                         const std::string& sample_dimension = "");

  /// One value of the row in hand of each column of a dimension.
  void put(std::size_t column, double value);
  void put_whole(std::size_t column, std::int64_t value);
  void put_word(std::size_t column, std::string_view word);
  void end_row(std::size_t dimension);
  /// Ends the file; it is on the disk then.
  void close();

 private:
  struct File;
  template <class Act>
  void attempt(Act&& act);

  std::filesystem::path path_;
  std::unique_ptr<File> file_;
};

}  // namespace freeplay
