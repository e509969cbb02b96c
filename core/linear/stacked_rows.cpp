#include "linear/stacked_rows.h"

#include <Eigen/QR>

namespace freeplay {
namespace {
constexpr double smallest_pivot = 1e-9;  // of the largest entry of A
}  // namespace

void StackedRows::add(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  if (a.rows() == 0 || free_.cols() == 0) return;
  const Eigen::MatrixXd reduced = a * free_;
  // Directions in which earlier ranks have left rounding alone are none.
  if (reduced.cwiseAbs().maxCoeff() <= smallest_pivot * a.cwiseAbs().maxCoeff()) return;
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
