// Constraint rows as small full matrices, for ranks and null spaces.
#pragma once

#include <Eigen/Core>

#include "linear/row_solutions.h"
#include "system/constraints.h"

namespace freeplay {

constexpr double counts_as_motion = 1e-6;  ///< share of a unit vector, as of a force

/// Phi_q by its entries, nc x nv.
Eigen::MatrixXd constraint_matrix(const ConstraintJacobian& jacobian, const ConstraintValues& e);
/// One above the other.
Eigen::MatrixXd stacked(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below);

}  // namespace freeplay
