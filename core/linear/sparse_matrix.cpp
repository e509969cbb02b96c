#include "linear/sparse_matrix.h"

namespace freeplay {

SparseMatrix sparse_matrix(Eigen::Index rows, Eigen::Index columns, const std::vector<SparseEntry>& entries) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace freeplay
