#include "linear/row_solutions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "linear/row_rank.h"
#include "linear/singular_values.h"
#include "linear/sparse_rows.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double full_rank = 1e-4;  // smallest pivot over the largest
constexpr double lightest = 1e-12;
constexpr Eigen::Index most_rows_for_singular_values = 300;

bool is_large(const SparseMatrix& j) { return j.cols() > most_dense_columns; }

Eigen::ColPivHouseholderQR<MatrixXd> decompose(const MatrixXd& matrix, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(threshold);
  qr.compute(matrix);
  return qr;
}

}  // namespace

int rank_of(const MatrixXd& a) { return a.size() == 0 ? 0 : static_cast<int>(decompose(a, rank_threshold).rank()); }

MatrixXd null_space(const MatrixXd& a, double threshold) {
  const Eigen::Index columns = a.cols();
  if (a.rows() == 0) return MatrixXd::Identity(columns, columns);
  const auto qr = decompose(a.transpose(), threshold);
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(columns, columns);
  return q.rightCols(columns - qr.rank());
}

VectorXd pivots(const MatrixXd& a) { return decompose(a, rank_threshold).matrixR().diagonal().cwiseAbs(); }

VectorXd least_norm_solution(const MatrixXd& a, const VectorXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  decomposition.setThreshold(threshold);
  decomposition.compute(a);
  return decomposition.solve(b);
}

VectorXd symmetric_solution(const MatrixXd& a, const VectorXd& b) { return a.ldlt().solve(b); }

SymmetricModes symmetric_modes(const MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VectorXd least_norm_solution(const SparseMatrix& j, const VectorXd& b) {
  if (j.rows() == 0) return VectorXd::Zero(j.cols());
  if (is_large(j)) return SparseRows(j, RowRank::tolerance).least_norm_solution(b);
  return least_norm_solution(MatrixXd(j), b, RowRank::tolerance);
}

VectorXd least_weighted_solution(const SparseMatrix& j, const VectorXd& weight, const VectorXd& b) {
  if (j.rows() == 0) return VectorXd::Zero(j.cols());
  if (is_large(j)) {
    const VectorXd root = weight.cwiseMax(lightest * weight.maxCoeff()).cwiseSqrt().cwiseInverse();
    return root.cwiseProduct(SparseRows(j * root.asDiagonal(), RowRank::tolerance).least_norm_solution(b));
  }
  VectorXd x = least_norm_solution(j, b);
  const MatrixXd n = null_space(j, RowRank::tolerance);
  if (n.cols() == 0) return x;
  const MatrixXd reduced = n.transpose() * weight.asDiagonal() * n;
  x -= n * least_norm_solution(reduced, n.transpose() * weight.cwiseProduct(x), RowRank::tolerance);
  return x;
}

int numerical_rank(const SparseMatrix& j) {
  if (j.rows() == 0 || j.cols() == 0) return 0;
  if (is_large(j)) return SparseRows(j, rank_threshold).rank();
  const MatrixXd a = j;
  const auto qr = decompose(a.transpose(), rank_threshold);
  // Pivots far above the threshold leave no doubt, nor does a rest of nothing; singular values cost ten times as much.
  const Eigen::ArrayXd sizes = qr.matrixR().diagonal().cwiseAbs();
  const bool clear = (sizes == 0.0 || sizes > full_rank * sizes.maxCoeff()).all();
  if (clear || a.rows() > most_rows_for_singular_values) return static_cast<int>(qr.rank());
  const VectorXd sigma = singular_values(a).sigma;
  int count = 0;
  while (count < sigma.size() && sigma[count] > rank_threshold * sigma[0] && sigma[count] > 0.0) ++count;
  return count;
}

std::optional<VectorXd> weightless_motion(const SparseMatrix& j, const VectorXd& weight) {
  if (is_large(j) || weight.minCoeff() > 0.0) return std::nullopt;
  const MatrixXd n = null_space(j, RowRank::tolerance);
  if (n.cols() == 0) return std::nullopt;
  const MatrixXd carried = n.transpose() * weight.asDiagonal() * n;
  const SymmetricModes modes = symmetric_modes(carried);
  if (modes.values[0] > lightest * weight.maxCoeff()) return std::nullopt;
  return n * modes.vectors.col(0);
}

}  // namespace freeplay
