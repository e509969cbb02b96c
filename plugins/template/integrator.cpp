// my-type: an integrator of your own. As it stands, the trapezoidal rule.
#include <algorithm>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

// What a model file may say under `integrator:`.
constexpr Parameter parameters[] = {newton_tolerance_parameter, newton_iterations_parameter};

/// With step h, start n, end 1:
///   v_1 = v_n + h/2 (a_n + a_1)   q_1 = q_n + h v_n + h^2/4 (a_n + a_1)   z_1 = z_n + h/2 (z'_n + z'_1)
/// Constraints hold in position; then the velocity is brought back to them and a, lambda are solved again.
class MyType final : public Integrator {
 public:
  explicit MyType(const Parameters& p)
      : tolerance_(p.number("newton.tolerance")), iterations_(p.integer("newton.max_iterations")) {}

  void declare(IntegratorLayout& layout) const override {
    const Sizes& n = layout.sizes;
    layout.memory = n.nz;                     // z' at the accepted state, kept from step to step
    layout.scratch = n.nq + 2 * n.nv + n.nz;  // what a stage knows, valid within an attempt
    layout.order = 2;
    layout.newton_tolerance = tolerance_;
    layout.newton_max_iterations = iterations_;
  }

  void restart(StateView& state, StageSolver& solver) const override { solver.accelerate(state, state.memory); }

  Attempt attempt(double h, StateView& to, Span<double> scratch, StageSolver& solver) const override {
    const std::size_t nq = to.q.size, nv = to.v.size;
    const Span<double> q = scratch.part(0, nq), v = scratch.part(nq, nv), increment = scratch.part(nq + nv, nv),
                       z = scratch.part(nq + 2 * nv, to.z.size);
    std::copy(to.q.begin(), to.q.end(), q.begin());
    for (std::size_t i = 0; i < nv; ++i) {
      v[i] = to.v[i] + 0.5 * h * to.a[i];
      increment[i] = h * to.v[i] + 0.25 * h * h * to.a[i];
    }
    for (std::size_t i = 0; i < to.z.size; ++i) z[i] = to.z[i] + 0.5 * h * to.memory[i];

    const Stage stage{.t = *to.t + h,
                      .q_base = q,
                      .increment_known = increment,
                      .v_known = v,
                      .z_known = z,
                      .beta_q = 0.25 * h * h,
                      .beta_v = 0.5 * h,
                      .beta_z = 0.5 * h,
                      .level = ConstraintLevel::position};
    if (solver.solve(stage, to).converged == 0) return {.converged = 0, .error = 0.0};
    solver.project_velocity(to);
    solver.accelerate(to, to.memory);
    return {.converged = 1, .error = 0.0};
  }

 private:
  double tolerance_;
  int iterations_;
};

}  // namespace

FREEPLAY_PLUGIN(my_type) {
  static const Component components[] = {
      integrator<MyType>({.name = "my-type",
                          .summary = "Trapezoidal rule, implicit, order 2.",
                          .formula = "v_1 = v_n + h/2 (a_n + a_1), q_1 = q_n + h v_n + h^2/4 (a_n + a_1).",
                          .validity = "Fixed steps; stiff modes that are excited ring on.",
                          .parameters = parameters}),
  };
  return publish(*host, *manifest, "my_type", "0.1.0", components);
}
