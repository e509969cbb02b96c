#include "linear/stacked_rows.h"

#include <Eigen/QR>

namespace freeplay {
void StackedRows::add(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double least) {
  if (a.rows() == 0 || free_.cols() == 0) return;
  const Eigen::MatrixXd reduced = a * free_;
  const double largest = reduced.cwiseAbs().maxCoeff(), floor = least * a.cwiseAbs().maxCoeff();
  if (largest <= floor) return;
  const double smallest_pivot = least > rounding ? floor / largest : rounding;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> rows;
  rows.setThreshold(smallest_pivot);
  rows.compute(reduced);
  x_ += free_ * rows.solve(b - a * x_);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> columns;
  columns.setThreshold(smallest_pivot);
  columns.compute(reduced.transpose());
  const Eigen::MatrixXd q = columns.householderQ() * Eigen::MatrixXd::Identity(free_.cols(), free_.cols());
  free_ = (free_ * q.rightCols(free_.cols() - columns.rank())).eval();
}

}  // namespace freeplay
