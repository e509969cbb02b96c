#include "assembly/row_stress.h"

#include <algorithm>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double full_rank = 1e-6;   // of the largest singular value
constexpr double takes_part = 1e-3;  // share of a joint in the stress that its rows add up to

}  // namespace

RowSvd::RowSvd(const ClosedMechanism::Rows& rows)
    : svd(singular_values(Eigen::MatrixXd(rows.matrix), SingularVectors::full)) {
  while (rank < svd.sigma.size() && svd.sigma[rank] > full_rank * svd.sigma[0]) ++rank;
}

std::vector<int> joints_under(const Eigen::VectorXd& stress, const ClosedMechanism::Rows& rows,
                              const ClosedMechanism& mechanism) {
  std::vector<int> joints;
  for (int j = 0; j < static_cast<int>(mechanism.model().joints.size()); ++j) {
    const Slice own = mechanism.system.layout().rows(j);
    double share = 0.0;
    for (std::size_t r = 0; r < rows.row.size(); ++r) {
      if (rows.row[r] < own.offset || rows.row[r] >= own.offset + own.size) continue;
      share = std::max(share, std::abs(stress[static_cast<Eigen::Index>(r)]));
    }
    if (share > takes_part * stress.lpNorm<Eigen::Infinity>()) joints.push_back(j);
  }
  return joints;
}

}  // namespace freeplay
