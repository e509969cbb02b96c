#include "assembly/row_space.h"

#include <algorithm>
#include <vector>

namespace freeplay {

using Eigen::MatrixXd;

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
