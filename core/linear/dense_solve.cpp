#include "linear/dense_solve.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "linear/row_rank.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rank_threshold = 1e-9;
constexpr Eigen::Index most_rows_for_singular_values = 300;

Eigen::CompleteOrthogonalDecomposition<MatrixXd> decompose(const MatrixXd& matrix) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  decomposition.setThreshold(RowRank::tolerance);
  decomposition.compute(matrix);
  return decomposition;
}

}  // namespace

VectorXd least_norm_solution(const MatrixXd& a, const VectorXd& b) {
  if (a.rows() == 0) return VectorXd::Zero(a.cols());
  return decompose(a).solve(b);
}

MatrixXd null_space(const MatrixXd& a, int columns) {
  if (a.rows() == 0) return MatrixXd::Identity(columns, columns);
  const auto d = decompose(a.transpose());
  const MatrixXd q = d.householderQ() * MatrixXd::Identity(columns, columns);
  return q.rightCols(columns - d.rank());
}

int numerical_rank(const MatrixXd& a) {
  if (a.rows() == 0 || a.cols() == 0) return 0;
  if (a.rows() > most_rows_for_singular_values) {
    Eigen::ColPivHouseholderQR<MatrixXd> qr;
    qr.setThreshold(rank_threshold);
    qr.compute(a.transpose());
    return static_cast<int>(qr.rank());
  }
  const VectorXd sigma = Eigen::JacobiSVD<MatrixXd>(a).singularValues();
  int count = 0;
  while (count < sigma.size() && sigma[count] > rank_threshold * sigma[0] && sigma[count] > 0.0) ++count;
  return count;
}

SmallestEigenpair smallest_eigenpair(const MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(symmetric);
  return {eigen.eigenvalues()[0], eigen.eigenvectors().col(0)};
}

}  // namespace freeplay
