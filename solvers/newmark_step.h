// Newmark step: the single stage that the methods of Newmark's family have in common.
#pragma once

#include <algorithm>
#include <cmath>

#include "freeplay/integrator.h"
#include "step_error.h"

namespace freeplay {

/// In what the methods of the family differ.
struct NewmarkWeights {
  double alpha_m, alpha_f, beta, gamma;
};

/// Newmark's rule with an auxiliary acceleration A in place of a (h: step, n: start, 1: end of the step, d: increment):
///
///   v_1 = v_n + h [(1 - gamma) A_n + gamma A_1]      d_1 = h v_n + h^2 [(1/2 - beta) A_n + beta A_1]
///   (1 - alpha_m) A_1 + alpha_m A_n = (1 - alpha_f) a_1 + alpha_f a_n,  so that  A_1 = k0 + k1 a_1
///   k0 = (alpha_f a_n - alpha_m A_n)/(1 - alpha_m)   k1 = (1 - alpha_f)/(1 - alpha_m)
///
/// Internal variables z follow the rule of v with an auxiliary rate Z. Constraints hold at position level; then v is
/// projected and a, lambda are solved again at the accepted state, which is the a_n of the next step. A keeps the
/// acceleration of the stage, and with it the damping of the method; where alpha_m = alpha_f = 0 it is a itself, as
/// otherwise a disturbance across the constraints would alternate for ever. Order 2 where gamma = 1/2 - alpha_m +
/// alpha_f. Arnold and Bruls 2007.
///
/// For smooth motion A is the acceleration at another instant: A_n = a(t_n + s h), s = alpha_m - alpha_f. A step of
/// another size than the last thus needs another A: a_n + (A_n - a_n) h/h_last keeps the order where steps vary. A
/// restart sets A = a, of order 1 in its first step; runs that control their error look ahead by one step for a'.
class NewmarkStep : public Integrator {
 public:
  void declare(IntegratorLayout& layout) const final {
    const Sizes& n = layout.sizes;
    layout.memory = n.nv + 2 * n.nz + 1;
    layout.scratch = n.nq + 4 * n.nv + 3 * n.nz + StepError::scratch(n);
    layout.error_estimate = 1;
    layout.order = std::abs(weights_.gamma - 0.5 + weights_.alpha_m - weights_.alpha_f) < 1e-12 ? 2 : 1;
    layout.newton_tolerance = tolerance_;
    layout.newton_max_iterations = iterations_;
  }

  void restart(StateView& state, StageSolver& solver) const final {
    const Memory m(state);
    if (!state.z.empty()) solver.accelerate(state, m.z_rate);
    take_over(state, m);
    m.last_step[0] = 0.0;
  }

  Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const final {
    const Known n(to, scratch);
    const Memory m(to);
    const double beta_v = weights_.gamma * k1_ * dt, beta_q = weights_.beta * k1_ * dt * dt;
    if (auxiliary_) fit_auxiliary(dt, to, m, scratch.part(n.used, scratch.size - n.used), solver);
    m.last_step[0] = dt;
    predict(dt, to, n, m);
    const Stage stage{.t = *to.t + dt,
                      .q_base = n.q,
                      .increment_known = n.increment,
                      .v_known = n.v,
                      .z_known = n.z,
                      .beta_q = beta_q,
                      .beta_v = beta_v,
                      .beta_z = beta_v,
                      .level = ConstraintLevel::position};
    if (solver.estimates()) n.keep_start(to, m.z_rate);
    if (solver.solve(stage, to).converged == 0) return {.converged = 0, .error = 0.0};
    for (std::size_t i = 0; i < n.v.size; ++i) n.increment[i] += beta_q * to.a[i];  // the whole increment
    for (std::size_t i = 0; i < m.a.size; ++i) m.a[i] += k1_ * to.a[i];
    for (std::size_t i = 0; i < m.z.size; ++i) m.z[i] += k1_ * (to.z[i] - n.z[i]) / beta_v;
    solver.project_velocity(to);
    solver.accelerate(to, m.z_rate);
    double error = 0.0;
    if (solver.estimates()) {
      StepError judge(to, scratch.part(n.used, scratch.size - n.used));
      error = judge(dt, {n.q, n.v_start, n.a_start, n.z_start, n.rate_start}, n.increment, to, m.z_rate, solver);
    }
    if (!auxiliary_) take_over(to, m);
    return {.converged = 1, .error = error};
  }

 protected:
  /// Reads the parameters of Newton's method.
  NewmarkStep(const Parameters& p, const NewmarkWeights& weights)
      : weights_(weights),
        k1_((1.0 - weights.alpha_f) / (1.0 - weights.alpha_m)),
        auxiliary_(weights.alpha_m != 0.0 || weights.alpha_f != 0.0),
        tolerance_(p.number("newton.tolerance")),
        iterations_(p.integer("newton.max_iterations")) {}

 private:
  /// A, Z and the z' that goes with the accepted state, in slices of the state's memory.
  struct Memory {
    explicit Memory(const StateView& s)
        : a(s.memory.part(0, s.v.size)),
          z(s.memory.part(s.v.size, s.z.size)),
          z_rate(s.memory.part(s.v.size + s.z.size, s.z.size)),
          last_step(s.memory.part(s.v.size + 2 * s.z.size, 1)) {}
    Span<double> a, z, z_rate, last_step;  ///< the last [s]; 0 after a restart
  };
  /// The base and the known terms of the stage, in slices of the scratch.
  struct Known {
    Known(const StateView& s, Span<double> scratch) {
      const auto take = [&](std::size_t count) {
        used += count;
        return scratch.part(used - count, count);
      };
      q = take(s.q.size);
      v = take(s.v.size);
      increment = take(s.v.size);
      z = take(s.z.size);
      v_start = take(s.v.size);
      a_start = take(s.v.size);
      z_start = take(s.z.size);
      rate_start = take(s.z.size);
      std::copy(s.q.begin(), s.q.end(), q.begin());
    }
    /// Before the stage overwrites it.
    void keep_start(const StateView& s, Span<const double> z_rate) const {
      std::copy(s.v.begin(), s.v.end(), v_start.begin());
      std::copy(s.a.begin(), s.a.end(), a_start.begin());
      std::copy(s.z.begin(), s.z.end(), z_start.begin());
      std::copy(z_rate.begin(), z_rate.end(), rate_start.begin());
    }
    std::size_t used = 0;
    Span<double> q, v, increment, z, v_start, a_start, z_start, rate_start;
  };

  static void take_over(const StateView& state, const Memory& m) {
    std::copy(state.a.begin(), state.a.end(), m.a.begin());
    std::copy(m.z_rate.begin(), m.z_rate.end(), m.z.begin());
  }

  /// Brings A and Z to the step at hand.
  void fit_auxiliary(double dt, const StateView& now, const Memory& m, Span<double> scratch,
                     StageSolver& solver) const {
    if (m.last_step[0] > 0.0) {
      const double ratio = dt / m.last_step[0];
      for (std::size_t i = 0; i < m.a.size; ++i) m.a[i] = now.a[i] + ratio * (m.a[i] - now.a[i]);
      for (std::size_t i = 0; i < m.z.size; ++i) m.z[i] = m.z_rate[i] + ratio * (m.z[i] - m.z_rate[i]);
    } else if (solver.estimates()) {
      StepError ahead(now, scratch);
      const double shift = weights_.alpha_m - weights_.alpha_f;
      ahead.look(dt, now, m.z_rate, solver);
      for (std::size_t i = 0; i < m.a.size; ++i) m.a[i] += shift * (ahead.acceleration()[i] - now.a[i]);
      for (std::size_t i = 0; i < m.z.size; ++i) m.z[i] += shift * (ahead.rate()[i] - m.z_rate[i]);
    }
  }

  /// Fills the known terms from the start of the step; leaves k0 in place of A and Z.
  void predict(double dt, const StateView& start, const Known& n, const Memory& m) const {
    const auto [alpha_m, alpha_f, beta, gamma] = weights_;
    for (std::size_t i = 0; i < start.v.size; ++i) {
      const double before = m.a[i];
      m.a[i] = (alpha_f * start.a[i] - alpha_m * before) / (1.0 - alpha_m);
      n.v[i] = start.v[i] + dt * ((1.0 - gamma) * before + gamma * m.a[i]);
      n.increment[i] = dt * (start.v[i] + dt * ((0.5 - beta) * before + beta * m.a[i]));
    }
    for (std::size_t i = 0; i < start.z.size; ++i) {
      const double before = m.z[i];
      m.z[i] = (alpha_f * m.z_rate[i] - alpha_m * before) / (1.0 - alpha_m);
      n.z[i] = start.z[i] + dt * ((1.0 - gamma) * before + gamma * m.z[i]);
    }
  }

  NewmarkWeights weights_;
  double k1_;
  bool auxiliary_;
  double tolerance_;
  int iterations_;
};

}  // namespace freeplay
