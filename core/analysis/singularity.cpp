#include "analysis/singularity.h"

#include <limits>

#include "linear/singular_values.h"

namespace freeplay {

const char* word(SingularityKind kind) {
  constexpr const char* words[] = {"none", "direct", "inverse", "both"};
  return words[static_cast<int>(kind)];
}

Singularity singularity_of(const VelocityMap& map, double length) {
  const Eigen::MatrixXd a = map.scaled_outputs(length);
  Singularity out;
  out.inverse_min = map.inverse_min;
  if (a.rows() >= a.cols() && a.cols() > 0) {
    const Eigen::VectorXd sigma = singular_values(a).sigma;
    out.sigma_min = sigma[sigma.size() - 1];
    out.sigma_max = sigma[0];
    out.manipulability = sigma.prod();
  }
  out.condition = out.sigma_min > 0.0 ? out.sigma_max / out.sigma_min : std::numeric_limits<double>::infinity();
  const bool direct = out.sigma_min < singular_limit, inverse = out.inverse_min < singular_limit;
  out.kind = static_cast<SingularityKind>((direct ? 1 : 0) + (inverse ? 2 : 0));
  return out;
}

}  // namespace freeplay
