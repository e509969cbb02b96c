#include "analysis/clearance_error.h"

#include "analysis/singularity.h"

namespace freeplay {

std::vector<Generator> generators_of(const IdealMechanism& mechanism, const VelocityMap& map) {
  std::vector<Generator> out;
  Eigen::Index place = 0;
  for (const Play& play : mechanism.plays()) {
    out.push_back({map.c.middleCols(place, 2), play.radius});
    place += 2;
  }
  for (Eigen::Index i = 0; i < map.b.cols(); ++i) out.push_back({map.b.col(i), mechanism.input_error()});
  return out;
}

std::optional<Eigen::MatrixXd> pseudo_inverse(const Eigen::MatrixXd& a, double length) {
  if (a.rows() < 3) return std::nullopt;
  Eigen::MatrixXd scaled = a;
  scaled.col(2) /= length;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (!(svd.singularValues()[2] >= singular_limit)) return std::nullopt;
  // The least squares solution does not depend on the scale of its unknowns.
  Eigen::MatrixXd out = svd.matrixV() * svd.singularValues().cwiseInverse().asDiagonal() * svd.matrixU().transpose();
  out.row(2) /= length;
  return out;
}

std::optional<ClearanceError> clearance_error(const IdealMechanism& mechanism, const VelocityMap& map) {
  const std::optional<Eigen::MatrixXd> inverse = pseudo_inverse(map.a, mechanism.length());
  if (!inverse) return std::nullopt;
  const std::vector<Generator> generators = generators_of(mechanism, map);
  std::vector<Generator> moving;
  for (const Generator& generator : generators) {
    if (generator.size > 0.0) moving.push_back(generator);
  }
  ClearanceError out;
  out.least_squares = least_squares_worst_case(*inverse, moving);
  out.exact = map.a.rows() == 3 ? out.least_squares : exact_worst_case(map.a, moving);
  for (const Generator& generator : generators) {
    out.sensitivity.push_back((generator.columns.transpose() * out.exact.multipliers).norm());
  }
  return out;
}

}  // namespace freeplay
