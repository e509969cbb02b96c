// Ranks and kernels of constraint rows, by decompositions of small full matrices.
#pragma once

#include <Eigen/Core>

#include "system/constraints.h"

namespace freeplay {

constexpr double rank_threshold = 1e-9;    ///< of pivots, by the largest; as that of the facts
constexpr double counts_as_motion = 1e-6;  ///< share of a unit vector, as of a force

/// Phi_q by its entries, nc x nv.
Eigen::MatrixXd constraint_matrix(const ConstraintJacobian& jacobian, const ConstraintValues& e);
int rank_of(const Eigen::MatrixXd& matrix);
/// Columns are orthonormal and span the x with matrix x = 0.
Eigen::MatrixXd kernel(const Eigen::MatrixXd& matrix);
/// One above the other.
Eigen::MatrixXd stacked(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below);

}  // namespace freeplay
