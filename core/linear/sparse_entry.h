// SparseEntry: one number of a sparse matrix and where it stands.
#pragma once

#include <cstddef>

namespace freeplay {

/// Entries at one place are added.
class SparseEntry {
 public:
  SparseEntry() = default;
  SparseEntry(std::ptrdiff_t row, std::ptrdiff_t column, double value)
      : row_(static_cast<int>(row)), column_(static_cast<int>(column)), value_(value) {}

  int row() const { return row_; }
  int col() const { return column_; }
  double value() const { return value_; }

 private:
  int row_ = 0, column_ = 0;
  double value_ = 0.0;
};

}  // namespace freeplay
