#include "analysis/mobility.h"

#include <algorithm>

#include "linear/row_solutions.h"

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::vector<SparseEntry> input_entries(PostureSolver& solver, const Evaluation& e, int first_row) {
  const Model& model = solver.mechanism().model();
  std::vector<SparseEntry> out;
  for (const int j : solver.mechanism().platform().inputs) {
    double row[6], bias = 0.0;
    solver.mechanism().system().coordinate_row(j, e, row, bias);
    const JointElement& joint = model.joints[at(j)];
    const BodyId bodies[2] = {model.markers[at(joint.marker_a)].body, model.markers[at(joint.marker_b)].body};
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < 3 && bodies[k] != ground; ++c) {
        out.emplace_back(first_row, 3 * bodies[k] + c, row[3 * k + c]);
      }
    }
    ++first_row;
  }
  return out;
}

}  // namespace

Mobility mobility_at(PostureSolver& solver, double t, const Posture& posture) {
  const System& system = solver.mechanism().system();
  const Evaluation& e = solver.evaluate(t, posture, term_position);
  const int nc = system.layout().nc(), nv = system.layout().nv();
  const int inputs = static_cast<int>(solver.mechanism().platform().inputs.size());
  std::vector<SparseEntry> entries;
  system.jacobian_entries(e, entries);
  const int joints = nc > 0 ? numerical_rank(sparse_matrix(nc, nv, entries)) : 0;
  const std::vector<SparseEntry> more = input_entries(solver, e, nc);
  entries.insert(entries.end(), more.begin(), more.end());
  const int all = numerical_rank(sparse_matrix(nc + inputs, nv, entries));
  return {nv - joints, nc - joints, nv - all, inputs - (all - joints)};
}

GeneralMobility general_mobility(PostureSolver& solver, double t, const Posture& posture) {
  GeneralMobility out;
  out.here = out.general = mobility_at(solver, t, posture);
  out.configurations = 1;
  const std::size_t bodies = solver.mechanism().model().bodies.size();
  // Every body is turned a little by another angle, and the joints are closed again.
  for (const double turn : {0.05, -0.05, 0.2, -0.2, 0.4}) {
    Posture moved = posture;
    for (std::size_t b = 0; b < bodies; ++b) {
      const double share = static_cast<double>(b + 1) * 0.6180339887498949;  // golden ratio: spread evenly
      moved.q[3 * b + 2] += turn * (2.0 * (share - std::floor(share)) - 1.0);
    }
    Demand demand;
    demand.t = t;
    if (!solver.settle(demand, moved)) continue;
    const Mobility there = mobility_at(solver, t, moved);
    ++out.configurations;
    out.general.freedoms = std::min(out.general.freedoms, there.freedoms);
    out.general.redundant_rows = std::min(out.general.redundant_rows, there.redundant_rows);
    out.general.held = std::min(out.general.held, there.held);
    out.general.redundant_inputs = std::min(out.general.redundant_inputs, there.redundant_inputs);
  }
  return out;
}

}  // namespace freeplay
