// ExplicitRungeKutta: an embedded pair of explicit Runge-Kutta methods, whatever its tableau.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "freeplay/plugin.h"

namespace freeplay {

/// Embedded pair on the index-1 form
///   d' = rate(d, v),  v' = a(t, q, v, z),  z' = z'(t, q, v, z)  with  q = retract(q_n, d)
/// where d' is v but for rotations in space (Munthe-Kaas 1999) and a comes from the equations of motion with the
/// constraints at acceleration level. The result of higher order is kept: q is projected on Phi = 0 and v on
/// Phi_q v = nu, which moves them by less than the local error, and what is solved for there is the first stage of the
/// next step. Hairer, Norsett and Wanner 1993, II.4.
///
/// A tableau whose two results err so much alike that their difference says too little has a factor `caution` for it.
/// A tableau has `stages` s, `order`, `error_order` (power of dt with which the difference of the pair falls), `node`
/// (s numbers), `weight` ((s + 1) x s: a row for each stage, as the last the result) and `error_weight` (s + 1 numbers:
/// result less the other order, the last that of the end of the step).
template <class Tableau>
class ExplicitRungeKutta : public Integrator {
 public:
  explicit ExplicitRungeKutta(const Parameters&) {}

  void declare(IntegratorLayout& layout) const override {
    const Sizes& n = layout.sizes;
    layout.memory = n.nz;  // z' at the accepted state
    layout.scratch = n.nq + derivatives * (2 * n.nv + n.nz) + 2 * n.nv + 2 * n.nz;
    layout.order = Tableau::order;
    layout.error_order = Tableau::error_order;
    layout.error_estimate = 1;
    layout.explicit_stages = 1;
    layout.always_adaptive = 1;
  }

  void restart(StateView& state, StageSolver& solver) const override {
    if (!state.z.empty()) solver.accelerate(state, state.memory);
  }

  Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const override {
    const Stages k(to, scratch);
    const double start = *to.t;
    make_stages(dt, start, k, to, solver, std::make_index_sequence<end - 1>{});
    *to.t = start + dt;
    advance<end>(dt, k, to);
    solver.retract(k.q, k.increment, to.q);
    solver.project_position(to);
    solver.project_velocity(to);
    solve<end>(k, to, solver);
    std::copy_n(k.z_rate(end).begin(), to.z.size, to.memory.begin());
    return {.converged = 1, .error = error(dt, k, to, solver)};
  }

 private:
  static constexpr int end = Tableau::stages;  // place of the derivatives at the end of the step
  static constexpr int derivatives = end + 1;

  /// Start of the step and derivatives (d', a, z') of every stage, in slices of the scratch.
  struct Stages {
    Stages(const StateView& s, Span<double> scratch)
        : nv(s.v.size),
          nz(s.z.size),
          q(scratch.part(0, s.q.size)),
          rest(scratch.part(s.q.size, scratch.size - s.q.size)) {
      increment = rest.part(derivatives * (2 * nv + nz), nv);
      spare = rest.part(derivatives * (2 * nv + nz) + nv, nv);
      z_start = rest.part(derivatives * (2 * nv + nz) + 2 * nv, nz);
      z_spare = rest.part(derivatives * (2 * nv + nz) + 2 * nv + nz, nz);
      std::copy(s.q.begin(), s.q.end(), q.begin());
      std::copy(s.v.begin(), s.v.end(), v(0).begin());
      std::copy(s.a.begin(), s.a.end(), a(0).begin());
      std::copy(s.z.begin(), s.z.end(), z_start.begin());
      std::copy(s.memory.begin(), s.memory.end(), z_rate(0).begin());
    }
    Span<double> v(int s) const { return rest.part(offset(s), nv); }
    Span<double> a(int s) const { return rest.part(offset(s) + nv, nv); }
    Span<double> z_rate(int s) const { return rest.part(offset(s) + 2 * nv, nz); }
    std::size_t offset(int s) const { return static_cast<std::size_t>(s) * (2 * nv + nz); }

    std::size_t nv, nz;
    Span<double> q, rest, increment, spare, z_start, z_spare;
  };

  template <std::size_t... s>
  static void make_stages(double dt, double start, const Stages& k, StateView& to, StageSolver& solver,
                          std::index_sequence<s...>) {
    (make_stage<static_cast<int>(s) + 1>(dt, start, k, to, solver), ...);
  }
  template <int s>
  static void make_stage(double dt, double start, const Stages& k, StateView& to, StageSolver& solver) {
    *to.t = start + Tableau::node[s] * dt;
    advance<s>(dt, k, to);
    solver.retract(k.q, k.increment, to.q);
    solve<s>(k, to, solver);
  }
  template <int s>
  static void solve(const Stages& k, StateView& to, StageSolver& solver) {
    solver.accelerate(to, k.z_rate(s));
    solver.increment_rate(k.increment, to.v, k.v(s));
    std::copy(to.a.begin(), to.a.end(), k.a(s).begin());
  }

  /// Those of a stage, of the result (`end`), or of the error (-1).
  static constexpr const double* weights(int s) {
    if (s < 0) return Tableau::error_weight;
    return Tableau::weight[s];
  }
  /// out = from (or 0) + dt times the sum of weights(s)[j] times what stands `stride` numbers further for each j.
  template <int s, std::size_t... j>
  static void sum(double dt, const double* from, const double* first, std::size_t stride, Span<double> out,
                  std::index_sequence<j...>) {
    constexpr const double* w = weights(s);
    const double scaled[] = {dt * w[j]...};
    for (std::size_t i = 0; i < out.size; ++i) {
      const double* at = first + i;
      double total = from == nullptr ? 0.0 : from[i];
      ((w[j] != 0.0 ? void(total += scaled[j] * at[j * stride]) : void()), ...);
      out.data[i] = total;
    }
  }
  template <int s>
  static void advance(double dt, const Stages& k, StateView& to) {
    const auto before = std::make_index_sequence<static_cast<std::size_t>(s)>{};
    const std::size_t stride = k.offset(1);
    sum<s>(dt, nullptr, k.v(0).data, stride, k.increment, before);
    sum<s>(dt, k.v(0).data, k.a(0).data, stride, to.v, before);
    sum<s>(dt, k.z_start.data, k.z_rate(0).data, stride, to.z, before);
  }

  static double error(double dt, const Stages& k, const StateView& to, StageSolver& solver) {
    const auto all = std::make_index_sequence<static_cast<std::size_t>(derivatives)>{};
    const std::size_t stride = k.offset(1);
    sum<-1>(dt, nullptr, k.v(0).data, stride, k.increment, all);
    sum<-1>(dt, nullptr, k.a(0).data, stride, k.spare, all);
    sum<-1>(dt, nullptr, k.z_rate(0).data, stride, k.z_spare, all);
    const double apart =
        std::max(solver.error_norm(k.increment, k.spare), solver.internal_error_norm(dt, to, k.z_spare));
    if constexpr (requires { Tableau::caution; }) return Tableau::caution * apart;
    return apart;
  }
};

}  // namespace freeplay
