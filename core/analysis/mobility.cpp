#include "analysis/mobility.h"

#include <algorithm>
#include <utility>

#include "base/index.h"
#include "linear/row_solutions.h"

namespace freeplay {
namespace {

std::vector<SparseEntry> input_entries(PostureSolver& solver, const Evaluation& e, int first_row) {
  const Model& model = solver.mechanism().model();
  std::vector<SparseEntry> out;
  const int width = solver.mechanism().system().layout().body_velocities();
  for (const int j : solver.mechanism().platform().inputs) {
    double row[2 * spatial::velocities], bias = 0.0;
    solver.mechanism().system().joints().coordinate_row(j, e, row, bias);
    const JointElement& joint = model.joints[at(j)];
    const BodyId bodies[2] = {model.markers[at(joint.marker_a)].body, model.markers[at(joint.marker_b)].body};
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < width && bodies[k] != ground; ++c) {
        out.emplace_back(first_row, width * bodies[k] + c, row[width * k + c]);
      }
    }
    ++first_row;
  }
  return out;
}

void add_frame(PostureSolver& solver, const Evaluation& e, int first_row, std::vector<SparseEntry>& out) {
  const System& system = solver.mechanism().system();
  const int marker = solver.mechanism().platform().marker, width = system.layout().body_velocities();
  for (const int component : solver.form().twist) {
    double g[6] = {}, row[spatial::velocities];
    g[component] = 1.0;
    system.markers().row(marker, g, e, row);
    for (int c = 0; c < width; ++c) {
      out.emplace_back(first_row, width * solver.mechanism().platform_body() + c, row[c]);
    }
    ++first_row;
  }
}

}  // namespace

Mobility mobility_at(PostureSolver& solver, double t, const Posture& posture) {
  const System& system = solver.mechanism().system();
  const Evaluation& e = solver.evaluate(t, posture, term_position);
  const int nc = system.layout().nc(), nv = system.layout().nv();
  const int inputs = static_cast<int>(solver.mechanism().platform().inputs.size());
  std::vector<SparseEntry> entries;
  system.jacobian().list(e.jacobian, entries);
  const int joints = nc > 0 ? numerical_rank(sparse_matrix(nc, nv, entries)) : 0;
  const std::vector<SparseEntry> more = input_entries(solver, e, nc);
  entries.insert(entries.end(), more.begin(), more.end());
  const int all = numerical_rank(sparse_matrix(nc + inputs, nv, entries));
  // Rank of the frame's rows beside those of the first `rows` rows.
  const auto frame_rank = [&](int rows, std::vector<SparseEntry> with, int rank) {
    add_frame(solver, e, rows, with);
    return numerical_rank(sparse_matrix(rows + solver.form().freedoms(), nv, with)) - rank;
  };
  Mobility out{nv - joints, nc - joints, nv - all, inputs - (all - joints)};
  out.platform_held = frame_rank(nc + inputs, entries, all);
  entries.resize(entries.size() - more.size());
  out.platform = frame_rank(nc, std::move(entries), joints);
  return out;
}

GeneralMobility general_mobility(PostureSolver& solver, double t, const Posture& posture) {
  GeneralMobility out;
  out.here = out.general = mobility_at(solver, t, posture);
  out.configurations = 1;
  const System& system = solver.mechanism().system();
  std::vector<double> increment(at(system.layout().nv()));
  // Every body is turned a little by another angle, and the joints are closed again.
  for (const double turn : {0.05, -0.05, 0.2, -0.2, 0.4}) {
    Posture moved = posture;
    int turns = 0;
    for (std::size_t i = 0; i < increment.size(); ++i) {
      if (!system.coordinates().is_turn(static_cast<int>(i))) continue;
      const double share = ++turns * 0.6180339887498949;  // golden ratio: spread evenly
      increment[i] = turn * (2.0 * (share - std::floor(share)) - 1.0);
    }
    system.coordinates().retract(posture.q, increment, moved.q);
    Demand demand;
    demand.t = t;
    if (!solver.settle(demand, moved)) continue;
    const Mobility there = mobility_at(solver, t, moved);
    ++out.configurations;
    out.general.freedoms = std::min(out.general.freedoms, there.freedoms);
    out.general.redundant_rows = std::min(out.general.redundant_rows, there.redundant_rows);
    out.general.held = std::min(out.general.held, there.held);
    out.general.redundant_inputs = std::min(out.general.redundant_inputs, there.redundant_inputs);
    out.general.platform = std::max(out.general.platform, there.platform);
    out.general.platform_held = std::min(out.general.platform_held, there.platform_held);
  }
  return out;
}

}  // namespace freeplay
