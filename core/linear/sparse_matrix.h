// Sparse matrices of constraint rows, made from their entries.
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "linear/sparse_entry.h"

namespace freeplay {

using SparseMatrix = Eigen::SparseMatrix<double>;

SparseMatrix sparse_matrix(Eigen::Index rows, Eigen::Index columns, const std::vector<SparseEntry>& entries);

/// Beyond so many columns decompositions are sparse: dense ones are surer of a rank, and cost the cube of the size.
inline constexpr Eigen::Index most_dense_columns = 600;

}  // namespace freeplay
