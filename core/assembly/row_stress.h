// RowStress: rows of a closed mechanism that depend on each other.
#pragma once

#include <vector>

#include <Eigen/Dense>

#include "assembly/closed_mechanism.h"

namespace freeplay {

/// Of the rows that hold and lead, by their singular values.
struct RowSvd {
  explicit RowSvd(const ClosedMechanism::Rows& rows);
  Eigen::BDCSVD<Eigen::MatrixXd> svd;
  Eigen::Index rank = 0;
};

/// Joints whose rows take part in a state of stress without load.
std::vector<int> joints_under(const Eigen::VectorXd& stress, const ClosedMechanism::Rows& rows,
                              const ClosedMechanism& mechanism);

}  // namespace freeplay
