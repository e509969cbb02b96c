#include "linear/row_rank.h"

#include <algorithm>
#include <cmath>

#include "linear/sparse_rows.h"

namespace freeplay {

RowRank::RowRank(int rows, int columns)
    : rows_(rows),
      columns_(columns),
      dependent_(static_cast<std::size_t>(rows), 0),
      done_(static_cast<std::size_t>(rows), 0) {
  if (is_large()) return;
  transposed_ = Eigen::MatrixXd::Zero(columns, rows);
  null_space_ = Eigen::MatrixXd::Zero(rows, rows);
  qr_ = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(columns, rows);
}

int RowRank::analyse(const std::vector<SparseEntry>& jacobian, double error) {
  const double zero = std::max(tolerance, error);
  std::ranges::fill(dependent_, char{0});
  rank_ = 0;
  if (rows_ == 0) return 0;
  if (is_large()) {
    sparse_ = sparse_matrix(rows_, columns_, jacobian);
    const SparseRows decomposed(sparse_, zero);
    std::ranges::copy(decomposed.dependent(), dependent_.begin());
    return rank_ = decomposed.rank();
  }
  transposed_.setZero();
  for (const SparseEntry& entry : jacobian) transposed_(entry.col(), entry.row()) += entry.value();
  qr_.compute(transposed_);
  const auto diagonal = qr_.matrixR().diagonal();
  const double largest = diagonal.size() > 0 ? std::abs(diagonal[0]) : 0.0;
  while (rank_ < diagonal.size() && std::abs(diagonal[rank_]) > zero * largest) ++rank_;
  const auto& order = qr_.colsPermutation().indices();
  for (int i = rank_; i < rows_; ++i) dependent_[static_cast<std::size_t>(order[i])] = 1;

  // J^T P = Q [R1 R2; 0 0]: the columns of P [-R1^-1 R2; 1] span the null space of J^T.
  const int free = rows_ - rank_;
  if (free == 0) return rank_;
  auto top = null_space_.block(0, 0, rank_, free);
  top = -qr_.matrixR().block(0, rank_, rank_, free);
  qr_.matrixR().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>().solveInPlace(top);
  null_space_.block(rank_, 0, free, free).setIdentity();
  return rank_;
}

int RowRank::weakest() const {
  if (rows_ == 0 || is_large()) return -1;
  const auto last = std::min(rows_, columns_) - 1;
  return qr_.colsPermutation().indices()[rows_ > columns_ ? last + 1 : last];
}

void RowRank::least_norm(std::span<double> lambda, int first_driver) {
  const int free = rows_ - rank_;
  if (free == 0) return;
  if (is_large()) return least_norm_multipliers(sparse_, first_driver, tolerance, lambda);
  const auto& order = qr_.colsPermutation().indices();
  // Gram-Schmidt in two passes: the first in the driver rows alone; what has no part there is left to the second.
  const auto within = [&](int row, bool drivers) { return (row >= first_driver) == drivers; };
  std::fill_n(done_.begin(), free, char{0});
  for (const bool drivers : {true, false}) {
    for (int pass = 0; pass < free; ++pass) {
      int pivot = -1;
      double largest = 0.0, whole = 0.0;
      for (int c = 0; c < free; ++c) {
        if (done_[static_cast<std::size_t>(c)]) continue;
        double part = 0.0, all = 0.0;
        for (int i = 0; i < rows_; ++i) {
          const double square = null_space_(i, c) * null_space_(i, c);
          all += square;
          if (within(order[i], drivers)) part += square;
        }
        if (part > largest) pivot = c, largest = part, whole = all;
      }
      if (pivot < 0 || largest <= tolerance * tolerance * whole) break;
      done_[static_cast<std::size_t>(pivot)] = 1;
      double along = 0.0;
      for (int i = 0; i < rows_; ++i) {
        if (within(order[i], drivers)) along += null_space_(i, pivot) * lambda[static_cast<std::size_t>(order[i])];
      }
      for (int i = 0; i < rows_; ++i) {
        lambda[static_cast<std::size_t>(order[i])] -= along / largest * null_space_(i, pivot);
      }
      for (int c = 0; c < free; ++c) {
        if (done_[static_cast<std::size_t>(c)]) continue;
        double common = 0.0;
        for (int i = 0; i < rows_; ++i) {
          if (within(order[i], drivers)) common += null_space_(i, pivot) * null_space_(i, c);
        }
        null_space_.col(c) -= common / largest * null_space_.col(pivot);
      }
    }
  }
}

}  // namespace freeplay
