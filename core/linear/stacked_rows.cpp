#include "linear/stacked_rows.h"

#include "linear/row_solutions.h"

namespace freeplay {
void StackedRows::add(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double least) {
  if (a.rows() == 0 || free_.cols() == 0) return;
  const Eigen::MatrixXd reduced = a * free_;
  const double largest = reduced.cwiseAbs().maxCoeff(), floor = least * a.cwiseAbs().maxCoeff();
  if (largest <= floor) return;
  const double smallest_pivot = least > rounding ? floor / largest : rounding;
  x_ += free_ * least_norm_solution(reduced, b - a * x_, smallest_pivot);
  free_ = (free_ * null_space(reduced, smallest_pivot)).eval();
}

}  // namespace freeplay
