#include "analysis/clearance_error.h"

#include "analysis/singularity.h"
#include "linear/singular_values.h"

namespace freeplay {

std::vector<Generator> generators_of(const IdealMechanism& mechanism, const VelocityMap& map) {
  std::vector<Generator> out;
  for (const Play& play : mechanism.plays()) {
    out.push_back({map.c.middleCols(play.place, play.size), play.radius, play.hull.get()});
  }
  for (Eigen::Index i = 0; i < map.b.cols(); ++i) out.push_back({map.b.col(i), mechanism.input_error()});
  return out;
}

std::optional<Eigen::MatrixXd> pseudo_inverse(const VelocityMap& map, double length) {
  const Eigen::MatrixXd scaled = map.scaled_outputs(length);
  if (scaled.rows() < scaled.cols()) return std::nullopt;
  const SingularValues svd = singular_values(scaled, SingularVectors::thin, SingularVectors::thin);
  if (!(svd.sigma[scaled.cols() - 1] >= singular_limit)) return std::nullopt;
  // The least squares solution does not depend on the scale of its unknowns.
  Eigen::MatrixXd out = svd.v * svd.sigma.cwiseInverse().asDiagonal() * svd.u.transpose();
  for (std::size_t k = 0; k < map.turns.size(); ++k) {
    if (map.turns[k]) out.row(static_cast<Eigen::Index>(k)) /= length;
  }
  return out;
}

std::optional<ClearanceError> clearance_error(const IdealMechanism& mechanism, const VelocityMap& map) {
  const std::optional<Eigen::MatrixXd> inverse = pseudo_inverse(map, mechanism.length());
  if (!inverse) return std::nullopt;
  const std::vector<Generator> generators = generators_of(mechanism, map);
  std::vector<Generator> moving;
  for (const Generator& generator : generators) {
    if (generator.size > 0.0) moving.push_back(generator);
  }
  ClearanceError out;
  out.least_squares = least_squares_worst_case(*inverse, moving);
  out.exact = map.a.rows() == map.a.cols() ? out.least_squares : exact_worst_case(map.a, moving);
  for (const Generator& generator : generators) {
    out.sensitivity.push_back(generator.support(out.exact.multipliers));
  }
  return out;
}

}  // namespace freeplay
