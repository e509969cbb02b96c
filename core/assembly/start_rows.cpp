#include "assembly/start_rows.h"

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "base/index.h"
#include "linear/row_solutions.h"
#include "system/path_row.h"

namespace freeplay {

ConstraintFacts constraint_facts(const ConstraintJacobian& jacobian, const ConstraintValues& e) {
  const Layout& layout = jacobian.layout();
  const int nc = layout.nc(), nv = layout.nv(), joints = layout.first_driver_row();
  std::vector<SparseEntry> entries;
  jacobian.list(e.jacobian, entries);
  const int all = numerical_rank(sparse_matrix(nc, nv, entries));
  std::erase_if(entries, [&](const SparseEntry& entry) { return entry.row() >= joints; });
  const int own = numerical_rank(sparse_matrix(joints, nv, entries));
  return {joints, own, joints - own, nv - own, nv - all, nc - all - (joints - own)};
}

void check_paths(const System& closed, const Evaluation& e) {
  const Model& model = closed.model();
  const int nv = closed.layout().nv();
  for (const InverseKinematics& entry : model.kinematics) {
    std::vector<SparseEntry> entries;
    closed.jacobian().list(e.jacobian, entries);
    for (int d = entry.first_driver; d < entry.first_driver + entry.driver_count; ++d) {
      const int driven = closed.layout().driver_row(d);
      std::erase_if(entries, [&](const SparseEntry& one) { return one.row() == driven; });
    }
    const int nc = closed.layout().nc();
    const SparseMatrix without = sparse_matrix(nc, nv, entries);
    const BodyId body = model.markers[at(entry.marker)].body;
    const std::vector<PathRow> paths = path_rows(model, static_cast<int>(&entry - model.kinematics.data()));
    const int given = static_cast<int>(paths.size());
    for (int i = 0; i < given && body != ground; ++i) {
      double row[6];
      paths[at(i)].entries(closed, e, row);
      const int width = closed.layout().body_velocities();
      for (int c = 0; c < width; ++c) entries.emplace_back(nc + i, width * body + c, row[c]);
    }
    const SparseMatrix with = sparse_matrix(nc + given, nv, entries);
    const int free = numerical_rank(without), prescribed = numerical_rank(with);
    if (prescribed < nv) {
      throw Error(Error::Category::input, "ik-underdetermined",
                  fmt::format("with its frame on the path of '{}' the mechanism still has {} freedom{}", entry.name,
                              nv - prescribed, nv - prescribed == 1 ? "" : "s"),
                  entry.frame_location);
    }
    if (prescribed < free + given) {
      throw Error(
          Error::Category::input, "ik-unreachable",
          fmt::format("the frame of '{}' cannot follow {} component{} of a path: the mechanism leaves it {} freedom{}",
                      entry.name, given, given == 1 ? "" : "s", prescribed - free, prescribed - free == 1 ? "" : "s"),
          entry.path_location);
    }
  }
}

void refuse_massless_motion(const System& system, const Evaluation& e) {
  const int nc = system.layout().nc(), nv = system.layout().nv();
  const Eigen::Map<const Eigen::VectorXd> mass(system.inertia().mass().data(), nv);
  std::vector<SparseEntry> entries;
  system.jacobian().list(e.jacobian, entries);
  const std::optional<Eigen::VectorXd> motion = weightless_motion(sparse_matrix(nc, nv, entries), mass);
  if (!motion) return;
  Eigen::Index worst = 0;
  motion->cwiseAbs().maxCoeff(&worst);
  const Body& body = system.model().bodies[at(static_cast<int>(worst) / system.layout().body_velocities())];
  throw Error(Error::Category::input, "singular-mass",
              fmt::format("body '{}' can move without moving any mass", body.name), body.location,
              "give it inertia, or hold that motion by a joint");
}

}  // namespace freeplay
