#include "linear/row_rank.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Householder>

#include "base/index.h"
#include "linear/sparse_rows.h"

namespace freeplay {

RowRank::RowRank(int rows, int columns)
    : rows_(rows),
      columns_(columns),
      dependent_(static_cast<std::size_t>(rows), 0),
      done_(static_cast<std::size_t>(rows), 0),
      order_(static_cast<std::size_t>(rows)),
      place_(static_cast<std::size_t>(rows)),
      kept_(rows) {
  if (is_large()) return;
  transposed_ = Eigen::MatrixXd::Zero(columns, rows);
  work_ = Eigen::VectorXd::Zero(rows);
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
  return rank_;
}

int RowRank::weakest() const {
  if (rows_ == 0 || is_large()) return -1;
  const auto last = std::min(rows_, columns_) - 1;
  return qr_.colsPermutation().indices()[rows_ > columns_ ? last + 1 : last];
}

// transposed_ <- J^T with the columns in order_.
void RowRank::fill_ordered(const std::vector<SparseEntry>& jacobian) {
  transposed_.setZero();
  for (const SparseEntry& entry : jacobian) transposed_(entry.col(), place_[at(entry.row())]) += entry.value();
}

LeftOutRows RowRank::express(const std::vector<SparseEntry>& jacobian, std::span<const char> left_out, double error) {
  zero_ = std::max(tolerance, error);
  if (is_large()) {
    sparse_ = sparse_matrix(rows_, columns_, jacobian);
    return {.rest = std::numeric_limits<double>::infinity()};
  }
  kept_ = 0;
  for (int r = 0; r < rows_; ++r) kept_ += left_out[at(r)] ? 0 : 1;
  for (int r = 0, kept = 0, out = kept_; r < rows_; ++r) {
    place_[at(r)] = left_out[at(r)] ? out++ : kept++;
    order_[at(place_[at(r)])] = r;
  }
  fill_ordered(jacobian);

  // J^T P = Q [R1 R2; 0 R3], by as many reflections as rows are kept: the columns of P [-R1^-1 R2; 1] are the null
  // space of J^T where R3 = 0.
  const int free = rows_ - kept_;
  LeftOutRows found;
  double pivot = 0.0;
  for (int k = 0; k < kept_; ++k) {
    double factor = 0.0, diagonal = 0.0;
    auto column = transposed_.col(k).tail(columns_ - k);
    column.makeHouseholderInPlace(factor, diagonal);
    transposed_.bottomRightCorner(columns_ - k, rows_ - k - 1)
        .applyHouseholderOnTheLeft(column.tail(columns_ - k - 1), factor, work_.data());
    column[0] = diagonal;
    pivot = std::max(pivot, std::abs(diagonal));
  }
  if (free == 0) return found;
  for (int c = 0; c < free; ++c) {
    found.rest = std::max(found.rest, transposed_.col(kept_ + c).tail(columns_ - kept_).norm() / pivot);
  }
  auto top = null_space_.block(0, 0, kept_, free);
  top = -transposed_.block(0, kept_, kept_, free);
  transposed_.topLeftCorner(kept_, kept_).triangularView<Eigen::Upper>().solveInPlace(top);
  null_space_.block(kept_, 0, free, free).setIdentity();
  for (int c = 0; c < free; ++c) {
    for (int i = 0; i < kept_; ++i) {
      if (!(std::abs(null_space_(i, c)) > found.largest)) continue;
      found.largest = std::abs(null_space_(i, c));
      found.kept = order_[at(i)];
      found.left_out = order_[at(kept_ + c)];
    }
  }
  return found;
}

void RowRank::least_norm(std::span<double> lambda, int first_driver) {
  const int free = rows_ - kept_;
  if (is_large()) return least_norm_multipliers(sparse_, first_driver, tolerance, lambda);
  if (free == 0) return;
  const std::vector<int>& order = order_;
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
          if (within(order[at(i)], drivers)) part += square;
        }
        if (part > largest) pivot = c, largest = part, whole = all;
      }
      if (pivot < 0 || largest <= zero_ * zero_ * whole) break;
      done_[static_cast<std::size_t>(pivot)] = 1;
      double along = 0.0;
      for (int i = 0; i < rows_; ++i) {
        if (within(order[at(i)], drivers)) along += null_space_(i, pivot) * lambda[at(order[at(i)])];
      }
      for (int i = 0; i < rows_; ++i) {
        lambda[at(order[at(i)])] -= along / largest * null_space_(i, pivot);
      }
      for (int c = 0; c < free; ++c) {
        if (done_[static_cast<std::size_t>(c)]) continue;
        double common = 0.0;
        for (int i = 0; i < rows_; ++i) {
          if (within(order[at(i)], drivers)) common += null_space_(i, pivot) * null_space_(i, c);
        }
        null_space_.col(c) -= common / largest * null_space_.col(pivot);
      }
    }
  }
}

}  // namespace freeplay
