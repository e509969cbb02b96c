// Dense decompositions for set-up: least-norm solutions, null spaces, ranks. They allocate; the time loop uses others.
#pragma once

#include <Eigen/Core>

namespace freeplay {

/// x of least norm among those that minimise |A x - b|; directions with pivots below 1e-10 of the largest do not count.
Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Orthonormal basis of {x : A x = 0} for a matrix with `columns` columns (which may have no rows).
Eigen::MatrixXd null_space(const Eigen::MatrixXd& a, int columns);

/// Number of singular values above 1e-9 of the largest; above 300 rows pivots of a QR decomposition with column
/// pivoting are counted instead, by the same threshold.
int numerical_rank(const Eigen::MatrixXd& a);

/// Smallest eigenvalue of a symmetric matrix and its unit eigenvector.
struct SmallestEigenpair {
  double value = 0.0;
  Eigen::VectorXd vector;
};
SmallestEigenpair smallest_eigenpair(const Eigen::MatrixXd& symmetric);

}  // namespace freeplay
