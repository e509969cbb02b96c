// ColumnBlock: rows of numbers in memory, column after column.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace freeplay {

/// Room is taken from the system for all rows beforehand; what no row has reached costs nothing. A copy shares the
/// memory and keeps the rows that it has: what is added to the original comes after them.
class ColumnBlock {
 public:
  ColumnBlock() = default;
  /// Throws std::bad_alloc.
  ColumnBlock(std::size_t columns, std::size_t expected_rows);

  /// Where more rows come than were expected, all move; copies stay where they are. Throws std::bad_alloc.
  void add(std::span<const double> row);

  const double* data() const { return data_.get(); }
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  /// Rows that there is room for: the distance between two columns.
  std::size_t room() const { return room_; }
  double at(std::size_t row, std::size_t column) const { return data()[column * room_ + row]; }

 private:
  std::size_t columns_ = 0, room_ = 0, rows_ = 0;
  std::shared_ptr<double> data_;
};

}  // namespace freeplay
