#include <Eigen/Eigenvalues>

#include "eigenvalue.h"

namespace freeplay::test {

double largest_eigenvalue(const std::array<double, 9>& matrix) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> m(matrix.data());
  return m.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace freeplay::test
