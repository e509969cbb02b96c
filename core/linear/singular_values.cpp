#include "linear/singular_values.h"

#include <Eigen/SVD>

namespace freeplay {

SingularValues singular_values(const Eigen::MatrixXd& a, SingularVectors left, SingularVectors right) {
  unsigned options = 0;
  if (left == SingularVectors::thin) options |= Eigen::ComputeThinU;
  if (left == SingularVectors::full) options |= Eigen::ComputeFullU;
  if (right == SingularVectors::thin) options |= Eigen::ComputeThinV;
  if (right == SingularVectors::full) options |= Eigen::ComputeFullV;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, options);
  SingularValues out{svd.singularValues(), {}, {}};
  if (left != SingularVectors::none) out.u = svd.matrixU();
  if (right != SingularVectors::none) out.v = svd.matrixV();
  return out;
}

}  // namespace freeplay
