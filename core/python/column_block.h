// ColumnBlock: rows of numbers in memory, column after column.
#pragma once

#include <cstddef>
#include <span>

namespace freeplay {

/// Room is taken from the system for all rows beforehand; what no row has reached costs nothing.
class ColumnBlock {
 public:
  /// Throws std::bad_alloc.
  ColumnBlock(std::size_t columns, std::size_t expected_rows);
  ~ColumnBlock();
  ColumnBlock(const ColumnBlock&) = delete;
  ColumnBlock& operator=(const ColumnBlock&) = delete;

  /// Where more rows come than were expected, all move. Throws std::bad_alloc.
  void add(std::span<const double> row);

  const double* data() const { return data_; }
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  /// Rows that there is room for: the distance between two columns.
  std::size_t room() const { return room_; }
  double at(std::size_t row, std::size_t column) const { return data_[column * room_ + row]; }

 private:
  std::size_t columns_, room_, rows_ = 0;
  double* data_;
};

}  // namespace freeplay
