#include <algorithm>
#include <cmath>

#include "freeplay/plugin.h"
#include "stage_history.h"
#include "step_error.h"

namespace freeplay {
namespace {

/// Composite method of Bathe: trapezoidal rule to t + s h, then three-point backward Euler to t + h. With velocities v,
/// accelerations a, increments d from the state n at the start of the step (h: step, s: split, rho: spectral radius
/// for h -> infinity):
///
///   v_s = v_n + s h/2 (a_n + a_s)                d_s = s h/2 (v_n + v_s)
///   v_1 = v_n + h (q0 a_n + q1 a_s + q2 a_1)     d_1 = h (q0 v_n + q1 v_s + q2 v_1)
///   q1 = (rho + 1)/(2 s (rho - 1) + 4)    q0 = 1/2 - (1 - s) q1    q2 = 1/2 - s q1 = (1 - s)/(2 + s (rho - 1))
///
/// Internal variables z follow the rule of v. Constraints hold at position level in stages that are solved, and at the
/// end of those that are left as predicted (StageHistory); then v is projected and a, lambda are solved again at the
/// accepted state, which makes every quantity of order 2, without drift. Bathe and Baig 2005; Bathe 2007; Noh and Bathe
/// 2018 (rho).
class Bathe final : public Integrator {
 public:
  explicit Bathe(const Parameters& p)
      : tolerance_(p.number("newton.tolerance")),
        iterations_(p.integer("newton.max_iterations")),
        most_unsolved_(p.integer("unsolved_steps")) {
    const double rho = p.number("rho_inf");
    const bool optimal = p.word("split") == 0;
    // s_0 = (2 - sqrt(2 + 2 rho))/(1 - rho), written so that rho = 1 is no exception.
    split_ = optimal ? 2.0 / (2.0 + std::sqrt(2.0 + 2.0 * rho)) : p.number("split");
    q1_ = (rho + 1.0) / (2.0 * split_ * (rho - 1.0) + 4.0);
    q0_ = 0.5 - (1.0 - split_) * q1_;
    // With the optimal split both stages have one matrix; equal bits let the host see it.
    q2_ = optimal ? 0.5 * split_ : (1.0 - split_) / (2.0 + split_ * (rho - 1.0));
  }

  void declare(IntegratorLayout& layout) const override {
    const Sizes& n = layout.sizes;
    layout.memory = n.nz + StageHistory::size(n, 2);  // z' at the accepted state
    layout.scratch = n.nq + 4 * n.nv + n.nc + 3 * n.nz + StepError::scratch(n);
    layout.order = 2;
    layout.error_estimate = 1;
    layout.newton_tolerance = tolerance_;
    layout.newton_max_iterations = iterations_;
  }
  void restart(StateView& state, StageSolver& solver) const override {
    if (!state.z.empty()) solver.accelerate(state, state.memory.part(0, state.z.size));
    StageHistory::forget(history_of(state));
  }

  Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const override {
    Start n(to, scratch);
    StageHistory history(dt, 2, n.a, n.lambda, history_of(to), most_unsolved_);
    const Span<double> z_rate = to.memory.part(0, to.z.size);
    const bool unsolved = n.z.empty() && !solver.estimates() && history.leaves_unsolved();
    const bool first_alone = unsolved && history.leaves_first_alone();
    if (unsolved && !first_alone) {
      follow_predictors(dt, n, to, solver, history);
      end_step(to, z_rate, solver);
      history.miss(to, n.increment_known);
      if (history.stands(solver.unsolved_error(q2_ * dt * q2_ * dt, q2_ * dt, n.increment_known))) {
        return {.converged = 1, .error = 0.0};
      }
    }
    if (!solve_stages(dt, n, to, solver, history, first_alone)) return {.converged = 0, .error = 0.0};
    if (first_alone && StageHistory::is_surprise(solver.guess_error()) &&
        !solve_stages(dt, n, to, solver, history, false)) {
      return {.converged = 0, .error = 0.0};
    }
    history.solved(1, to, solver.guess_error());
    if (solver.estimates()) {
      const double beta_q = q2_ * dt * q2_ * dt;
      for (std::size_t i = 0; i < n.v.size; ++i) n.increment_known[i] += beta_q * to.a[i];  // now the whole increment
    }
    end_step(to, z_rate, solver);
    double error = 0.0;
    if (solver.estimates()) {
      StepError judge(to, scratch.part(n.used, scratch.size - n.used));
      error = judge(dt, {n.q, n.v, n.a, n.z, n.z_rate}, n.increment_known, to, z_rate, solver);
    }
    history.finish(to);
    return {.converged = 1, .error = error};
  }

 private:
  /// Values at the start of the step and the known terms of the present stage, in slices of the scratch.
  struct Start {
    Start(const StateView& state, Span<double> scratch) : t(*state.t) {
      const auto take = [&](std::size_t count) {
        used += count;
        return scratch.part(used - count, count);
      };
      q = take(state.q.size);
      v = take(state.v.size);
      a = take(state.v.size);
      lambda = take(state.lambda.size);
      z = take(state.z.size);
      v_known = take(state.v.size);
      increment_known = take(state.v.size);
      z_known = take(state.z.size);
      z_rate = take(state.z.size);
      std::ranges::copy(state.q, q.begin());
      std::ranges::copy(state.v, v.begin());
      std::ranges::copy(state.a, a.begin());
      std::ranges::copy(state.lambda, lambda.begin());
      std::ranges::copy(state.z, z.begin());
      std::ranges::copy(state.memory.part(0, z.size), z_rate.begin());
    }
    double t;
    std::size_t used = 0;
    Span<double> q, v, a, lambda, z, v_known, increment_known, z_known, z_rate;
  };

  static void end_step(StateView& to, Span<double> z_rate, StageSolver& solver) {
    solver.project_velocity(to);
    solver.accelerate(to, z_rate);
  }

  /// Positions and velocities at the end of a step with the accelerations of both stages as they are guessed.
  void follow_predictors(double dt, Start& n, StateView& to, StageSolver& solver, StageHistory& history) const {
    const double q0 = q0_, q1 = q1_, b = q2_ * dt, b_first = 0.5 * split_ * dt;
    *to.t = n.t + dt;
    history.predict_both(split_, 1.0, [&](std::size_t i, double a_first, double a_end) {
      const double v = n.v[i], a = n.a[i], v_first = v + b_first * a + b_first * a_first,
                   v_known = v + dt * (q0 * a + q1 * a_first);
      to.v[i] = v_known + b * a_end;
      n.increment_known[i] = dt * (q0 * v + q1 * v_first) + b * v_known + b * b * a_end;
    });
    solver.retract(n.q, n.increment_known, to.q);
  }

  /// Both, or the second after the first as it is predicted.
  bool solve_stages(double dt, Start& n, StateView& to, StageSolver& solver, StageHistory& history,
                    bool second_alone) const {
    history.predict(0, split_, to);
    prepare_trapezoid(dt, n, to);
    if (second_alone) {
      for (std::size_t i = 0; i < n.v.size; ++i) to.v[i] = n.v_known[i] + 0.5 * split_ * dt * to.a[i];
    } else {
      if (!solve(n.t + split_ * dt, 0.5 * split_ * dt, n, to, solver)) return false;
      history.solved(0, to, solver.guess_error());
    }
    prepare_end(dt, n, to);
    history.predict(1, 1.0, to);
    return solve(n.t + dt, q2_ * dt, n, to, solver);
  }

  void prepare_trapezoid(double dt, Start& n, const StateView& to) const {
    const double b = 0.5 * split_ * dt;
    for (std::size_t i = 0; i < n.v.size; ++i) {
      n.v_known[i] = n.v[i] + b * n.a[i];
      n.increment_known[i] = b * (n.v[i] + n.v_known[i]);
    }
    for (std::size_t i = 0; i < n.z.size; ++i) n.z_known[i] = n.z[i] + b * to.memory[i];
  }
  static Span<double> history_of(StateView& state) {
    return state.memory.part(state.z.size, state.memory.size - state.z.size);
  }

  /// The known terms of backward Euler; `to` holds the stage at t + s h.
  void prepare_end(double dt, Start& n, const StateView& to) const {
    const double q0 = q0_, q1 = q1_, b = q2_ * dt, b_first = 0.5 * split_ * dt;
    for (std::size_t i = 0; i < n.v.size; ++i) {
      n.v_known[i] = n.v[i] + dt * (q0 * n.a[i] + q1 * to.a[i]);
      n.increment_known[i] = dt * (q0 * n.v[i] + q1 * to.v[i]) + b * n.v_known[i];
    }
    for (std::size_t i = 0; i < n.z.size; ++i) {
      const double rate = (to.z[i] - n.z_known[i]) / b_first;
      n.z_known[i] = n.z[i] + dt * (q0 * to.memory[i] + q1 * rate);
    }
  }

  static bool solve(double t, double b, const Start& n, StateView& to, StageSolver& solver) {
    const Stage stage{.t = t,
                      .q_base = n.q,
                      .increment_known = n.increment_known,
                      .v_known = n.v_known,
                      .z_known = n.z_known,
                      .beta_q = b * b,
                      .beta_v = b,
                      .beta_z = b,
                      .level = ConstraintLevel::position};
    return solver.solve(stage, to).converged != 0;
  }

  double tolerance_;
  int iterations_, most_unsolved_;
  double split_, q0_, q1_, q2_;
};

constexpr Parameter bathe_parameters[] = {
    {.name = "split",
     .default_value = 0.5,
     .minimum = 0.0,
     .maximum = 1.0,
     .open = Open::both,
     .choices = "optimal",
     .summary = "Fraction of the step taken by the trapezoidal rule; 'optimal' gives the least period error."},
    {.name = "rho_inf",
     .default_value = 0.0,
     .minimum = 0.0,
     .maximum = 1.0,
     .summary = "Spectral radius for large steps: 0 damps high frequencies most, 1 not at all."},
    {.name = "unsolved_steps",
     .kind = ParameterKind::integer,
     .default_value = 15,
     .minimum = 0,
     .maximum = 1000,
     .summary = "In steps of one size: how many in a row may leave their stages as predicted, while the error of the "
                "prediction is below the tolerance of the iteration; 0 solves every stage."},
    newton_tolerance_parameter,
    newton_iterations_parameter,
};

}  // namespace

Component bathe() {
  return integrator<Bathe>(
      {.name = "bathe",
       .summary = "Two-step composite method, implicit, order 2, damps high frequencies.",
       .formula =
           "v_s = v_n + s h/2 (a_n + a_s), d_s = s h/2 (v_n + v_s); v_1 = v_n + h (q0 a_n + q1 a_s + q2 a_1), d_1 = h "
           "(q0 v_n + q1 v_s + q2 v_1); q1 = (rho + 1)/(2 s (rho - 1) + 4), q0 = (s - 1) q1 + 1/2, q2 = 1/2 - s q1; "
           "optimal s = (2 - sqrt(2 + 2 rho))/(1 - rho).",
       .validity =
           "Stable for every step. What moves faster than ten steps a period is damped, the more the smaller rho_inf; "
           "for motions to follow, take steps below a twentieth of their period.",
       .references = "Bathe and Baig 2005, Comput Struct 83; Bathe 2007, Comput Struct 85; Noh and Bathe 2018, Comput "
                     "Struct 202",
       .parameters = bathe_parameters,
       .preferred = 1});
}

}  // namespace freeplay
