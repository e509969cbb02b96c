#include "linear/sparse_rows.h"

#include <algorithm>
#include <new>

// Before Eigen's wrapper, which needs it.
#include <Eigen/SPQRSupport>
#include <SuiteSparseQR.hpp>

namespace freeplay {
namespace {

constexpr double part_of_reactions = 1e-4;

double largest_column(const SparseMatrix& matrix) {
  double largest = 0.0;
  for (Eigen::Index c = 0; c < matrix.outerSize(); ++c) largest = std::max(largest, matrix.col(c).norm());
  return largest;
}

/// Throws std::bad_alloc where SPQR has no memory, which leaves no factors and no word in what Eigen knows of it.
void factor(Eigen::SPQR<SparseMatrix>& qr, const SparseMatrix& matrix, double threshold) {
  qr.cholmodCommon()->print = 0;  // its messages would stand among the program's own
  qr.setPivotThreshold(threshold);
  qr.compute(matrix);
  if (qr.cholmodCommon()->status < CHOLMOD_OK) throw std::bad_alloc();
}

}  // namespace

struct SparseRows::Impl {
  Eigen::SPQR<SparseMatrix> qr;
};

SparseRows::SparseRows(const SparseMatrix& j, double tolerance) : impl_(std::make_unique<Impl>()) {
  const SparseMatrix transposed = j.transpose();
  factor(impl_->qr, transposed, tolerance * largest_column(transposed));
}

SparseRows::~SparseRows() = default;

int SparseRows::rank() const { return static_cast<int>(impl_->qr.rank()); }

std::vector<char> SparseRows::dependent() const {
  const auto permutation = impl_->qr.colsPermutation();
  const auto& order = permutation.indices();
  std::vector<char> out(static_cast<std::size_t>(order.size()), 0);
  for (Eigen::Index i = impl_->qr.rank(); i < order.size(); ++i) out[static_cast<std::size_t>(order[i])] = 1;
  return out;
}

Eigen::VectorXd SparseRows::least_norm_solution(const Eigen::VectorXd& b) const {
  const Eigen::Index rank = impl_->qr.rank();
  const Eigen::VectorXd ordered = impl_->qr.colsPermutation().transpose() * b;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(impl_->qr.rows());
  if (rank > 0) {
    const SparseMatrix all = impl_->qr.matrixR(), top = all.topLeftCorner(rank, rank);
    y.head(rank) = top.transpose().triangularView<Eigen::Lower>().solve(ordered.head(rank));
  }
  return impl_->qr.matrixQ() * y;
}

// Least norm of D lambda: D lambda is brought into the range of D^-1 J.
void least_norm_multipliers(const SparseMatrix& j, int first_driver, double tolerance, std::span<double> lambda) {
  Eigen::VectorXd weight = Eigen::VectorXd::Constant(j.rows(), part_of_reactions);
  weight.tail(j.rows() - first_driver).setOnes();
  Eigen::Map<Eigen::VectorXd> all(lambda.data(), j.rows());
  const SparseMatrix weighted = weight.cwiseInverse().asDiagonal() * j;
  Eigen::SPQR<SparseMatrix> qr;
  factor(qr, weighted, tolerance * largest_column(weighted));
  const Eigen::VectorXd right = weight.cwiseProduct(all), x = qr.solve(right);
  all = weight.cwiseInverse().cwiseProduct(weighted * x);
}

}  // namespace freeplay
