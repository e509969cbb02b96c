#include "linear/row_solutions.h"

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
constexpr double rank_threshold = 1e-9;
constexpr double lightest = 1e-12;
constexpr Eigen::Index most_rows_for_singular_values = 300;

bool is_large(const SparseMatrix& j) { return j.cols() > most_dense_columns; }

Eigen::CompleteOrthogonalDecomposition<MatrixXd> decompose(const MatrixXd& matrix) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  decomposition.setThreshold(RowRank::tolerance);
  decomposition.compute(matrix);
  return decomposition;
}

// Orthonormal basis of {x : A x = 0}.
MatrixXd null_space(const MatrixXd& a) {
  const Eigen::Index columns = a.cols();
  if (a.rows() == 0) return MatrixXd::Identity(columns, columns);
  const auto d = decompose(a.transpose());
  const MatrixXd q = d.householderQ() * MatrixXd::Identity(columns, columns);
  return q.rightCols(columns - d.rank());
}

}  // namespace

VectorXd least_norm_solution(const SparseMatrix& j, const VectorXd& b) {
  if (j.rows() == 0) return VectorXd::Zero(j.cols());
  if (is_large(j)) return SparseRows(j, RowRank::tolerance).least_norm_solution(b);
  return decompose(j).solve(b);
}

VectorXd least_weighted_solution(const SparseMatrix& j, const VectorXd& weight, const VectorXd& b) {
  if (j.rows() == 0) return VectorXd::Zero(j.cols());
  if (is_large(j)) {
    const VectorXd root = weight.cwiseMax(lightest * weight.maxCoeff()).cwiseSqrt().cwiseInverse();
    return root.cwiseProduct(SparseRows(j * root.asDiagonal(), RowRank::tolerance).least_norm_solution(b));
  }
  VectorXd x = least_norm_solution(j, b);
  const MatrixXd n = null_space(j);
  if (n.cols() == 0) return x;
  const MatrixXd reduced = n.transpose() * weight.asDiagonal() * n;
  x -= n * decompose(reduced).solve(n.transpose() * weight.cwiseProduct(x));
  return x;
}

int numerical_rank(const SparseMatrix& j) {
  if (j.rows() == 0 || j.cols() == 0) return 0;
  if (is_large(j)) return SparseRows(j, rank_threshold).rank();
  const MatrixXd a = j;
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(rank_threshold);
  qr.compute(a.transpose());
  // Pivots far above the threshold leave no doubt, nor does a rest of nothing; singular values cost ten times as much.
  const Eigen::ArrayXd pivots = qr.matrixR().diagonal().cwiseAbs();
  const bool clear = (pivots == 0.0 || pivots > full_rank * pivots.maxCoeff()).all();
  if (clear || a.rows() > most_rows_for_singular_values) return static_cast<int>(qr.rank());
  const VectorXd sigma = singular_values(a).sigma;
  int count = 0;
  while (count < sigma.size() && sigma[count] > rank_threshold * sigma[0] && sigma[count] > 0.0) ++count;
  return count;
}

std::optional<VectorXd> weightless_motion(const SparseMatrix& j, const VectorXd& weight) {
  if (is_large(j) || weight.minCoeff() > 0.0) return std::nullopt;
  const MatrixXd n = null_space(j);
  if (n.cols() == 0) return std::nullopt;
  const MatrixXd carried = n.transpose() * weight.asDiagonal() * n;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(carried);
  if (eigen.eigenvalues()[0] > lightest * weight.maxCoeff()) return std::nullopt;
  return n * eigen.eigenvectors().col(0);
}

}  // namespace freeplay
