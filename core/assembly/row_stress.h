// RowStress: rows of a closed mechanism that depend on each other.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "assembly/closed_mechanism.h"
#include "linear/singular_values.h"

namespace freeplay {

/// Of the rows that hold and lead, by their singular values.
struct RowSvd {
  explicit RowSvd(const ClosedMechanism::Rows& rows);
  SingularValues svd;  ///< with all of U
  Eigen::Index rank = 0;
};

/// Joints whose rows take part in a state of stress without load.
std::vector<int> joints_under(const Eigen::VectorXd& stress, const ClosedMechanism::Rows& rows,
                              const ClosedMechanism& mechanism);

}  // namespace freeplay
