// SingularValues: a matrix as two turns and what it stretches. Compiled once: it takes longer than most files of ours.
#pragma once

#include <Eigen/Core>

namespace freeplay {

/// a = U diag(sigma) V^T with columns of length 1 and sigma [min(m, n)] falling, of a [m x n].
struct SingularValues {
  Eigen::VectorXd sigma;
  Eigen::MatrixXd u, v;  ///< as they were asked for, otherwise empty
};

/// Columns of U or V: none, as many as sigma has, or all of the space.
enum class SingularVectors { none, thin, full };

SingularValues singular_values(const Eigen::MatrixXd& a, SingularVectors left = SingularVectors::none,
                               SingularVectors right = SingularVectors::none);

}  // namespace freeplay
