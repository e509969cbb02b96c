#include "linear/least_squares.h"

#include <cmath>

namespace freeplay {

bool LeastSquares::factor() {
  constexpr double smallest_pivot = 1e-10;
  const Eigen::Index columns = matrix.cols();
  if (matrix.rows() < columns) return false;
  qr_.compute(matrix);
  const auto& r = qr_.matrixQR();
  return columns == 0 || std::abs(r(columns - 1, columns - 1)) > smallest_pivot * std::abs(r(0, 0));
}

void LeastSquares::solve(std::span<const double> b, std::span<double> x) {
  const auto& qr = qr_.matrixQR();
  const Eigen::Index rows = qr.rows(), columns = qr.cols();
  right_ = Eigen::Map<const Eigen::VectorXd>(b.data(), rows);
  // Q^T b, one reflector (1, v) after the other; then R x = Q^T b.
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Eigen::Index below = rows - k - 1;
    const double along = right_[k] + qr.col(k).tail(below).dot(right_.tail(below));
    const double scaled = qr_.hCoeffs()[k] * along;
    right_[k] -= scaled;
    right_.tail(below) -= scaled * qr.col(k).tail(below);
  }
  const auto& order = qr_.colsPermutation().indices();
  for (Eigen::Index k = columns; k-- > 0;) {
    const Eigen::Index after = columns - k - 1;
    right_[k] = (right_[k] - qr.row(k).tail(after).transpose().dot(right_.segment(k + 1, after))) / qr(k, k);
    x[static_cast<std::size_t>(order[k])] = right_[k];
  }
}

}  // namespace freeplay
