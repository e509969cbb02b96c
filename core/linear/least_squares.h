// LeastSquares: many right sides for one tall matrix of full column rank, without allocation.
#pragma once

#include <span>

#include <Eigen/QR>

namespace freeplay {

/// Column-pivoted QR of a rows x columns matrix. Sized once.
class LeastSquares {
 public:
  LeastSquares(int rows, int columns) : matrix(rows, columns), qr_(rows, columns), right_(rows) {}

  /// Decomposes `matrix`; false when its columns are dependent (pivots below 1e-10 of the largest).
  bool factor();
  /// x that minimises |matrix x - b|.
  void solve(std::span<const double> b, std::span<double> x);

  Eigen::MatrixXd matrix;

 private:
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  Eigen::VectorXd right_;
};

}  // namespace freeplay
