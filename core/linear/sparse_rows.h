// SparseRows: rank and solutions of least norm of many constraint rows.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "linear/sparse_matrix.h"

namespace freeplay {

/// Rank-revealing sparse QR of J^T by SPQR (Davis 2011, ACM TOMS 38, algorithm 915), J being rows x columns:
/// J^T P = Q [R1 R2; 0 0]. A column of J^T counts as dependent when what is left of it beside those before it is below
/// `tolerance` of the largest column (Heath 1982).
class SparseRows {
 public:
  SparseRows(const SparseMatrix& j, double tolerance);
  ~SparseRows();

  int rank() const;
  /// By row: nonzero for those that the others determine.
  std::vector<char> dependent() const;
  /// x of least norm with J x = b in the independent rows.
  Eigen::VectorXd least_norm_solution(const Eigen::VectorXd& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Moves multipliers along the null space of J^T to least norm, rows from `first_driver` on before the others (as
/// RowRank::least_norm() does exactly, here to 1e-8 of them: the others count 1e-4 as much).
void least_norm_multipliers(const SparseMatrix& j, int first_driver, double tolerance, std::span<double> lambda);

}  // namespace freeplay
