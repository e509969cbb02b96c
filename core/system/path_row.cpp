#include "system/path_row.h"

#include <cmath>

#include "base/angle.h"
#include "base/index.h"

namespace freeplay {

void PathRow::entries(const Evaluation& e, double* row) const {
  double g[6] = {};
  g[planar::components[component]] = 1.0;
  planar::body_row(g, e.arms[at(marker)], row);
}

double PathRow::residual(const System& system, const Point& point, const Evaluation& e, double path) const {
  if (component < 2) return e.markers[at(marker)].position[component] - path;
  const double error = system.markers().angle(marker, point.q) - path;
  return without_turns(error);
}

double PathRow::gamma(const Evaluation& e, double path_acceleration) const {
  double g[6] = {};
  g[planar::components[component]] = 1.0;
  return path_acceleration - planar::velocity_product(g, e.arms[at(marker)]);
}

std::vector<PathRow> path_rows(const Model& model, int kinematics) {
  const InverseKinematics& entry = model.kinematics[at(kinematics)];
  std::vector<PathRow> rows;
  for (int i = 0; i < 3; ++i) {
    if (entry.path[at(i)]) rows.push_back({kinematics, i, entry.marker, model.markers[at(entry.marker)].body});
  }
  return rows;
}

}  // namespace freeplay
