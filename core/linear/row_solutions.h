// What set-up asks of constraint rows: solutions of least norm, ranks, motions that they leave free. Dense up to
// most_dense_columns, sparse beyond. All of it allocates; the time loop uses others. Decompositions of full matrices
// are compiled here alone: each takes longer than most files of ours.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "linear/sparse_matrix.h"

namespace freeplay {

/// x of least norm among those that minimise |J x - b|; directions with pivots below 1e-10 of the largest do not count.
/// Of many rows those that contradict others are left out instead.
Eigen::VectorXd least_norm_solution(const SparseMatrix& j, const Eigen::VectorXd& b);

/// The same with sum w_i x_i^2 as small as J x = b allows, and x of least norm where the weights say nothing. Weights
/// may be zero.
Eigen::VectorXd least_weighted_solution(const SparseMatrix& j, const Eigen::VectorXd& weight, const Eigen::VectorXd& b);

/// Number of singular values above 1e-9 of the largest; above 300 rows pivots of a QR decomposition are counted
/// instead, by the same threshold.
int numerical_rank(const SparseMatrix& j);

/// A motion x, J x = 0, that moves no weight: sum w_i x_i^2 is below 1e-12 of the largest weight for |x| = 1. Only
/// looked for up to most_dense_columns.
std::optional<Eigen::VectorXd> weightless_motion(const SparseMatrix& j, const Eigen::VectorXd& weight);

constexpr double rank_threshold = 1e-9;  ///< of pivots, by the largest

/// Of full matrices, by a QR decomposition with pivots, as those below.
int rank_of(const Eigen::MatrixXd& a);
/// Orthonormal columns that span the x with A x = 0; pivots of A^T below `threshold` of the largest count as none.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& a, double threshold = rank_threshold);
/// Sizes of the pivots in their order; the first is the largest.
Eigen::VectorXd pivots(const Eigen::MatrixXd& a);
/// x of least norm among those that minimise |A x - b|; pivots below `threshold` of the largest count as none.
Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold);
/// A x = b with A symmetric, positive or negative definite (LDL^T).
Eigen::VectorXd symmetric_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// A = V diag(values) V^T of a symmetric A: values rise, columns of V are orthonormal.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricModes symmetric_modes(const Eigen::MatrixXd& a);

}  // namespace freeplay
