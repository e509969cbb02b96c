// RowRank: which rows of a constraint Jacobian are independent, and multipliers of least norm when some are not.
#pragma once

#include <span>
#include <vector>

#include <Eigen/QR>

#include "linear/sparse_matrix.h"

namespace freeplay {

/// Rows that are left out, as sums of those that are kept.
struct LeftOutRows {
  double rest = 0.0;     ///< largest part of one that no sum of the others has, by the largest pivot of the others
  double largest = 0.0;  ///< largest factor in these sums: as much more independent would be the other choice of ...
  int kept = -1;         ///< ... this row, that is kept, ...
  int left_out = -1;     ///< ... and this one
};

/// Rank-revealing decomposition of J^T (column-pivoted QR), J being nc x nv with columns in m and rad.
/// Sized once; analyse(), express() and least_norm() do not allocate up to most_columns. Beyond, all are sparse.
class RowRank {
 public:
  RowRank(int rows, int columns);

  /// Relative size below which a pivot counts as zero (theory of redundant constraints, threshold of the largest
  /// pivot).
  static constexpr double tolerance = 1e-10;

  /// Dense decompositions cost the third power of the columns, and redundant mechanisms ask for one in every stage.
  static constexpr int most_columns = 150;

  /// Decomposes J. Returns the rank. `error` says how far off, relative to its largest, the entries may be: smaller
  /// pivots count as zero, too.
  int analyse(const std::vector<SparseEntry>& jacobian, double error = 0.0);
  int rank() const { return rank_; }
  /// Nonzero for rows that the others determine. Valid after analyse().
  std::span<const char> dependent() const { return dependent_; }

  /// The row that adds least to those before it, -1 where there are too many to say. Valid after analyse().
  int weakest() const;

  /// Writes the rows that are marked as sums of the others, as nearly as can be (least squares): smooth in J, also
  /// where J is a little off the constraints and no row depends exactly. Beyond most_columns `rest` is infinite,
  /// and nothing is known.
  /// `error` as of analyse().
  LeftOutRows express(const std::vector<SparseEntry>& jacobian, std::span<const char> left_out, double error = 0.0);

  /// Moves multipliers along the null space of J^T that express() has found: first the rows from `first_driver` on get
  /// least norm among themselves, then the rows before it. The resultant J^T lambda does not change.
  void least_norm(std::span<double> lambda, int first_driver);

 private:
  bool is_large() const { return columns_ > most_columns; }
  void fill_ordered(const std::vector<SparseEntry>& jacobian);

  int rows_, columns_, rank_ = 0;
  SparseMatrix sparse_;  // J, where it is large
  Eigen::MatrixXd transposed_, null_space_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  std::vector<char> dependent_, done_;
  std::vector<int> order_, place_;  // of express(): row by place, kept ones first; place by row
  int kept_;
  double zero_ = tolerance;  // parts of null vectors below count as none
  Eigen::VectorXd work_;
};

}  // namespace freeplay
