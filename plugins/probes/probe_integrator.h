// Probe: an integrator that does nothing wrong: half a step with the accelerations of each end.
#pragma once

#include <algorithm>

#include "freeplay/plugin.h"

namespace freeplay::probe {

struct Mean : Integrator {
  explicit Mean(const Parameters&) {}

  void declare(IntegratorLayout& layout) const override {
    const Sizes& n = layout.sizes;
    layout.memory = n.nz;
    layout.scratch = n.nq + 2 * n.nv + n.nz;
    layout.order = 2;
  }
  void restart(StateView& state, StageSolver& solver) const override { solver.accelerate(state, state.memory); }
  Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const override {
    const std::size_t nq = to.q.size, nv = to.v.size, nz = to.z.size;
    const Span<double> q = scratch.part(0, nq), v = scratch.part(nq, nv), d = scratch.part(nq + nv, nv),
                       z = scratch.part(nq + 2 * nv, nz);
    const double b = 0.5 * dt;
    std::copy(to.q.begin(), to.q.end(), q.begin());
    for (std::size_t i = 0; i < nv; ++i) {
      v[i] = to.v[i] + b * to.a[i];
      d[i] = b * to.v[i] + b * v[i];
    }
    for (std::size_t i = 0; i < nz; ++i) z[i] = to.z[i] + b * to.memory[i];
    const Stage stage{*to.t + dt, q, d, v, z, b * b, b, b, ConstraintLevel::position};
    if (solver.solve(stage, to).converged == 0) return {0, 0.0};
    solver.project_velocity(to);
    solver.accelerate(to, to.memory);
    return {1, 0.0};
  }
};

}  // namespace freeplay::probe
