#include "assembly/row_space.h"

#include <algorithm>
#include <vector>

#include <Eigen/Dense>

namespace freeplay {

using Eigen::MatrixXd;

namespace {

Eigen::ColPivHouseholderQR<MatrixXd> decompose(const MatrixXd& matrix) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(matrix);
  qr.setThreshold(rank_threshold);
  return qr;
}

}  // namespace

int rank_of(const MatrixXd& matrix) { return matrix.size() == 0 ? 0 : static_cast<int>(decompose(matrix).rank()); }

MatrixXd kernel(const MatrixXd& matrix) {
  const Eigen::Index n = matrix.cols();
  if (matrix.rows() == 0) return MatrixXd::Identity(n, n);
  const auto qr = decompose(matrix.transpose());
  const MatrixXd q = qr.householderQ();
  return q.rightCols(n - qr.rank());
}

MatrixXd stacked(const MatrixXd& above, const MatrixXd& below) {
  MatrixXd all(above.rows() + below.rows(), std::max(above.cols(), below.cols()));
  if (above.rows() > 0) all.topRows(above.rows()) = above;
  if (below.rows() > 0) all.bottomRows(below.rows()) = below;
  return all;
}

MatrixXd constraint_matrix(const ConstraintJacobian& jacobian, const ConstraintValues& e) {
  std::vector<SparseEntry> entries;
  jacobian.list(e.jacobian, entries);
  MatrixXd matrix = MatrixXd::Zero(jacobian.layout().nc(), jacobian.layout().nv());
  for (const SparseEntry& entry : entries) matrix(entry.row(), entry.col()) += entry.value();
  return matrix;
}

}  // namespace freeplay
