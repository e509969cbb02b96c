// RowPairs: the rows of two results side by side.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "results/reader.h"

namespace freeplay {

/// Goes through two results at the times of the first, with a block of each in memory. Times are the same to 1e-9 of
/// the longer mean interval between rows.
class RowPairs {
 public:
  /// Some columns of each, `time` first, as many of the one as of the other; of the first the rows from <= time <=
  /// until.
  RowPairs(ResultReader& first, std::span<const std::size_t> first_columns, ResultReader& second,
           std::span<const std::size_t> second_columns, double from, double until);

  /// The next row of the first result that the second has, too, or that lies between two rows of it. False at the end.
  bool next();
  std::span<const double> first() const { return first_.row(); }
  /// At the same time: a row, or what lies between two rows, on straight lines.
  std::span<const double> second() const { return second_row_; }

  // After the last row:
  std::size_t rows() const { return rows_; }
  bool interpolated() const { return interpolated_; }
  /// Rows in the window that lie outside of the times of the other result.
  std::size_t first_alone() const { return first_alone_; }
  std::size_t second_alone() const { return second_alone_; }

 private:
  /// Times of a result as far as it was written when they were looked at.
  struct Extent {
    std::size_t rows = 0;
    double first = 0.0, last = 0.0;
    double interval() const;
  };
  class Walk {
   public:
    Walk(ResultReader& reader, std::span<const std::size_t> columns, std::size_t rows)
        : source_(reader.open_rows(columns)), width_(columns.size()), left_(rows) {}
    bool next();
    bool there() const { return there_; }
    std::span<const double> row() const { return block_.first(width_); }
    double time() const { return block_.front(); }

   private:
    std::unique_ptr<RowSource> source_;
    std::size_t width_, left_;
    std::span<const double> block_;  // begins with the row
    bool there_ = false;
  };

  static Extent extent(ResultReader& reader);
  bool inside(double time) const { return time >= from_ - same_ && time <= until_ + same_; }
  void advance_second();
  bool place(double time);

  const double from_, until_;
  const Extent first_extent_, second_extent_;
  const double same_;  // times that differ by no more are the same [s]
  Walk first_, second_;
  std::vector<double> before_;  // the row of the second result before the one it is at; empty at its start
  std::vector<double> between_;
  std::span<const double> second_row_;
  std::size_t rows_ = 0, first_alone_ = 0, second_alone_ = 0;
  bool interpolated_ = false;
};

}  // namespace freeplay
