// An oscillator in place of a model: an integrator of the solvers library drives it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../parameter_stub.h"

extern "C" freeplay::Status freeplay_plugin_v1_solvers(const freeplay::Host*, freeplay::Manifest*) noexcept;

namespace freeplay::test {

/// q'' = -omega^2 q - 2 zeta omega q', and apart from it z' = -decay z. Stages are linear and solved in closed form.
/// With `bent` q'' has 2 q q' besides, which stages leave out: with omega = 0 then q = tan(t) is a motion.
/// `post_solve` is what the acceleration solved again at the end of a step has on top.
struct Oscillator {
  double omega = 1.0, zeta = 0.0, decay = 0.0;
  int stages_to_converge = 1000;
  double post_solve = 0.0;
  bool bent = false;
  bool estimates = false;  ///< the run asks for errors, in units of 1 m and 1 m/s
  double allowed = 0.0;    ///< error in velocity that a stage may leave [m/s]; 0: the host tells nothing of guesses
  double off_rows = 0.0;   ///< what is reported of unsolved stages besides
  double push = 0.0, push_from = 1e300;  ///< further acceleration [m/s2], and since when [s]
  bool internal = true;                  ///< there is z
  int projections = 0, accelerations = 0;
  std::vector<Stage> stages{};
  std::vector<double> guesses{}, solutions{};

  double acceleration(double q, double v, double t = 0.0) const {
    return -omega * omega * q - 2.0 * zeta * omega * v + (t >= push_from ? push : 0.0);
  }

  abi::StageSolverTable table() {
    return {sizeof(abi::StageSolverTable),
            this,
            solve,
            project_velocity,
            project_position,
            accelerate,
            error_norm,
            retract,
            estimates ? 1u : 0u,
            nullptr,
            nullptr,
            allowed > 0.0 ? guess_error : nullptr,
            allowed > 0.0 ? unsolved_error : nullptr};
  }
  static Oscillator& self(void* s) { return *static_cast<Oscillator*>(s); }
  static Status solve(void* s, const Stage* stage, StateView* out, StageResult* result, Message*) noexcept {
    Oscillator& o = self(s);
    o.stages.push_back(*stage);
    o.guesses.push_back(out->a[0]);
    if (static_cast<int>(o.stages.size()) > o.stages_to_converge) {
      *result = {0, 20};
      return Status::ok;
    }
    const double q = stage->q_base[0] + stage->increment_known[0], v = stage->v_known[0];
    const double a = o.acceleration(q, v, stage->t) /
                     (1.0 + o.omega * o.omega * stage->beta_q + 2.0 * o.zeta * o.omega * stage->beta_v);
    *out->t = stage->t;
    o.solutions.push_back(a);
    out->a[0] = a;
    out->v[0] = v + stage->beta_v * a;
    out->q[0] = q + stage->beta_q * a;
    if (!out->z.empty()) out->z[0] = stage->z_known[0] / (1.0 + o.decay * stage->beta_z);
    *result = {1, 1};
    return Status::ok;
  }
  static double guess_error(void* s) noexcept {
    const Oscillator& o = self(s);
    return std::abs(o.solutions.back() - o.guesses.back()) * o.stages.back().beta_v / o.allowed;
  }
  static double unsolved_error(void* s, double beta_q, double beta_v, Span<const double> missed) noexcept {
    return std::abs(missed[0]) * std::max(beta_q, beta_v) / self(s).allowed + self(s).off_rows;
  }
  static Status project_velocity(void* s, StateView*, Message*) noexcept {
    ++self(s).projections;
    return Status::ok;
  }
  static Status project_position(void*, StateView*, Message*) noexcept { return Status::ok; }
  static double error_norm(void* s, Span<const double> position, Span<const double> velocity) noexcept {
    return self(s).estimates ? std::max(std::abs(position[0]), std::abs(velocity[0])) : 0.0;
  }
  static void retract(void*, Span<const double> base, Span<const double> d, Span<double> q) noexcept {
    q[0] = base[0] + d[0];
  }
  static Status accelerate(void* s, StateView* state, Span<double> z_rate, Message*) noexcept {
    ++self(s).accelerations;
    state->a[0] = self(s).acceleration(state->q[0], state->v[0], *state->t) + self(s).post_solve;
    if (self(s).bent) state->a[0] += 2.0 * state->q[0] * state->v[0];
    if (!state->z.empty()) z_rate[0] = -self(s).decay * state->z[0];
    return Status::ok;
  }
};

/// One state of the oscillator and the integrator that drives it.
struct OscillatorRun {
  OscillatorRun(const std::string& name, const ParameterStub& parameters, Oscillator model, double q0, double v0,
                double z0 = 0.0)
      : integrator(component(freeplay_plugin_v1_solvers, name), parameters), oscillator(model) {
    layout.sizes = {1, 1, 0, oscillator.internal ? 1 : 0};
    integrator.call(&abi::IntegratorTable::declare, &layout);
    memory.resize(static_cast<std::size_t>(layout.memory));
    scratch.assign(static_cast<std::size_t>(layout.scratch), std::numeric_limits<double>::quiet_NaN());
    q[0] = q0;
    v[0] = v0;
    z[0] = z0;
    a[0] = oscillator.acceleration(q0, v0) + (oscillator.bent ? 2.0 * q0 * v0 : 0.0);
    StateView s = state();
    const abi::StageSolverTable table = oscillator.table();
    integrator.call(&abi::IntegratorTable::restart, &s, &table);
  }
  StateView state() { return {&t, q, v, a, {}, {z, oscillator.internal ? 1u : 0u}, {memory.data(), memory.size()}}; }
  Attempt step(double dt) {
    Attempt result{};
    StateView s = state();
    const abi::StageSolverTable table = oscillator.table();
    integrator.call(&abi::IntegratorTable::attempt, dt, &s, Span<double>(scratch.data(), scratch.size()), &table,
                    &result);
    return result;
  }
  IntegratorInstance integrator;
  Oscillator oscillator;
  IntegratorLayout layout;
  double t = 0.0, q[1], v[1], a[1], z[1];
  std::vector<double> memory, scratch;
};

}  // namespace freeplay::test
