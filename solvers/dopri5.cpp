#include <algorithm>
#include <cmath>

#include "freeplay/plugin.h"

namespace freeplay {
namespace {

constexpr int stages = 7;
/// Dormand and Prince 1980, RK5(4)7M: nodes, weights of the stages, and the difference of the weights of order 5
/// (the last row of `a`) and 4. The last stage is the end of the step.
constexpr double node[stages] = {0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0};
constexpr double weight[stages][stages - 1] = {
    {},
    {1.0 / 5.0},
    {3.0 / 40.0, 9.0 / 40.0},
    {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0}};
constexpr double error_weight[stages] = {71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
                                         -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};

/// Explicit Runge-Kutta pair of orders 5 and 4 on the index-1 form
///   d' = rate(d, v),  v' = a(t, q, v, z),  z' = z'(t, q, v, z)  with  q = retract(q_n, d)
/// where d' is v but for rotations in space (Munthe-Kaas 1999) and a comes from the equations of motion with the
/// constraints at acceleration level. At the end of the step q is projected on Phi = 0 and v on Phi_q v = nu, which
/// moves them by less than the local error; the last stage is taken there, and is the first of the next step. The
/// result of order 5 is kept. Dormand and Prince 1980; Hairer, Norsett and Wanner 1993, II.5.
class Dopri5 final : public Integrator {
 public:
  explicit Dopri5(const Parameters&) {}

  void declare(IntegratorLayout& layout) const override {
    const Sizes& n = layout.sizes;
    layout.memory = n.nz;  // z' at the accepted state
    layout.scratch = n.nq + stages * (2 * n.nv + n.nz) + 2 * n.nv + 2 * n.nz;
    layout.order = 5;
    layout.error_order = 5;
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
    for (int s = 1; s < stages; ++s) {
      *to.t = start + node[s] * dt;
      advance(dt, s, k, to);
      solver.retract(k.q, k.increment, to.q);
      if (s == stages - 1) {
        solver.project_position(to);
        solver.project_velocity(to);
      }
      solver.accelerate(to, k.z_rate(s));
      solver.increment_rate(k.increment, to.v, k.v(s));
      std::copy(to.a.begin(), to.a.end(), k.a(s).begin());
    }
    std::copy_n(k.z_rate(stages - 1).begin(), to.z.size, to.memory.begin());
    return {.converged = 1, .error = error(dt, k, to, solver)};
  }

 private:
  /// Start of the step and derivatives (d', a, z') of every stage, in slices of the scratch.
  struct Stages {
    Stages(const StateView& s, Span<double> scratch)
        : nv(s.v.size),
          nz(s.z.size),
          q(scratch.part(0, s.q.size)),
          rest(scratch.part(s.q.size, scratch.size - s.q.size)) {
      increment = rest.part(stages * (2 * nv + nz), nv);
      spare = rest.part(stages * (2 * nv + nz) + nv, nv);
      z_start = rest.part(stages * (2 * nv + nz) + 2 * nv, nz);
      z_spare = rest.part(stages * (2 * nv + nz) + 2 * nv + nz, nz);
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

  /// out += sum over stages j of dt w_j times what stands `stride` numbers further for each.
  template <int count>
  static void add_stages(double dt, const double* w, const double* of_first, std::size_t stride, Span<double> out) {
    double step[count];
    for (int j = 0; j < count; ++j) step[j] = dt * w[j];
    for (std::size_t i = 0; i < out.size; ++i) {
      double sum = out.data[i];
      for (int j = 0; j < count; ++j) sum += step[j] * of_first[static_cast<std::size_t>(j) * stride + i];
      out.data[i] = sum;
    }
  }
  template <int count>
  static void add_all(double dt, const double* w, const Stages& k, Span<double> d, Span<double> v, Span<double> z) {
    const std::size_t stride = k.offset(1);
    add_stages<count>(dt, w, k.v(0).data, stride, d);
    add_stages<count>(dt, w, k.a(0).data, stride, v);
    add_stages<count>(dt, w, k.z_rate(0).data, stride, z);
  }

  /// increment, v and z of stage s from the derivatives of those before.
  static void advance(double dt, int s, const Stages& k, StateView& to) {
    std::fill(k.increment.begin(), k.increment.end(), 0.0);
    std::copy(k.v(0).begin(), k.v(0).end(), to.v.begin());
    std::copy(k.z_start.begin(), k.z_start.end(), to.z.begin());
    constexpr decltype(&add_all<1>) by_stage[stages] = {nullptr,    add_all<1>, add_all<2>, add_all<3>,
                                                        add_all<4>, add_all<5>, add_all<6>};
    by_stage[s](dt, weight[s], k, k.increment, to.v, to.z);
  }

  static double error(double dt, const Stages& k, const StateView& end, StageSolver& solver) {
    std::fill(k.increment.begin(), k.increment.end(), 0.0);
    std::fill(k.spare.begin(), k.spare.end(), 0.0);
    std::fill(k.z_spare.begin(), k.z_spare.end(), 0.0);
    add_all<stages>(dt, error_weight, k, k.increment, k.spare, k.z_spare);
    return std::max(solver.error_norm(k.increment, k.spare), solver.internal_error_norm(dt, end, k.z_spare));
  }
};

}  // namespace

Component dopri5() {
  return integrator<Dopri5>(
      {.name = "dopri5",
       .summary = "Explicit Runge-Kutta pair of orders 5 and 4 with projection, always adaptive.",
       .formula =
           "d' = v, v' = a, z' = g with M a + Phi_q^T lambda = f, Phi_q a = gamma; seven stages, the last is the "
           "first of the next step; then q on Phi = 0 and v on Phi_q v = nu; error: difference of the orders.",
       .validity = "Motions that are not stiff against the accuracy asked for: impacts are not, stiff dampers are.",
       .references = "Dormand and Prince 1980, J Comput Appl Math 6, 19-26; Hairer, Norsett and Wanner 1993, Solving "
                     "Ordinary Differential Equations I, II.5",
       .preferred = 2});
}

}  // namespace freeplay
