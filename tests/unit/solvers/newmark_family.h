// What every method of Newmark's family is asked: amplification, memory, order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "eigenvalue.h"
#include "oscillator.h"

namespace freeplay::test {

using Numbers = std::map<std::string, double>;

inline ParameterStub family_parameters(const std::string& name, const Numbers& numbers) {
  ParameterStub stub(component(freeplay_plugin_v1_solvers, name));
  stub.numbers = numbers;
  return stub;
}
inline OscillatorRun family_run(const std::string& name, const Numbers& numbers, Oscillator model, double q0, double v0,
                                double z0 = 0.0) {
  return {name, family_parameters(name, numbers), model, q0, v0, z0};
}

/// End of one step: position, velocity and the auxiliary acceleration in memory.
struct OneStep {
  double q, v, a;
};

/// One step of the undamped oscillator (omega 1, h 0.1) from (1, 0) and of the damped one (omega 3, zeta 0.05, h 0.25)
/// from (0.2, -1), by the matrix recursion of the method in double precision.
inline void expect_one_step(const std::string& name, const Numbers& numbers, const OneStep& undamped,
                            const OneStep& damped) {
  const struct {
    Oscillator model;
    double q0, v0, h;
    OneStep end;
  } cases[] = {{{.omega = 1.0}, 1.0, 0.0, 0.1, undamped}, {{.omega = 3.0, .zeta = 0.05}, 0.2, -1.0, 0.25, damped}};
  for (const auto& c : cases) {
    OscillatorRun run = family_run(name, numbers, c.model, c.q0, c.v0);
    ASSERT_EQ(run.step(c.h).converged, 1);
    EXPECT_NEAR(run.q[0], c.end.q, 1e-13);
    EXPECT_NEAR(run.v[0], c.end.v, 1e-13);
    EXPECT_NEAR(run.memory[0], c.end.a, 1e-13);
    // The state holds the acceleration that belongs to it.
    EXPECT_EQ(run.a[0], c.model.acceleration(run.q[0], run.v[0]));
    EXPECT_EQ(run.t, c.h);
  }
}

/// Largest absolute eigenvalue of one step (q, v, A) -> (q, v, A) of the undamped oscillator.
inline double spectral_radius(const std::string& name, const Numbers& numbers, double step_per_period) {
  std::array<double, 9> amplification{};
  for (int i = 0; i < 3; ++i) {
    OscillatorRun run = family_run(name, numbers, {}, i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0);
    run.memory[0] = i == 2 ? 1.0 : 0.0;
    run.step(2.0 * M_PI * step_per_period);
    const double column[] = {run.q[0], run.v[0], run.memory[0]};
    for (int k = 0; k < 3; ++k) amplification[static_cast<std::size_t>(3 * k + i)] = column[k];
  }
  return largest_eigenvalue(amplification);
}

/// log2 of the ratio of the largest errors of 400 and 800 steps for the damped oscillator and for z.
inline void expect_order(const std::string& name, const Numbers& numbers, double order) {
  const auto errors = [&](int steps) {
    OscillatorRun run = family_run(name, numbers, {.omega = 2.0, .zeta = 0.1, .decay = 1.5}, 1.0, 0.0, 1.0);
    double in_q = 0.0, in_z = 0.0;
    for (int i = 1; i <= steps; ++i) {
      run.step(1.0 / steps);
      // q = exp(-zeta omega t)(cos w t + zeta omega/w sin w t), w = omega sqrt(1 - zeta^2)
      const double t = static_cast<double>(i) / steps, w = 2.0 * std::sqrt(0.99);
      in_q = std::max(in_q, std::abs(run.q[0] - std::exp(-0.2 * t) * (std::cos(w * t) + 0.2 / w * std::sin(w * t))));
      in_z = std::max(in_z, std::abs(run.z[0] - std::exp(-1.5 * t)));
    }
    return std::pair(in_q, in_z);
  };
  const auto [coarse_q, coarse_z] = errors(400);
  const auto [fine_q, fine_z] = errors(800);
  EXPECT_NEAR(std::log2(coarse_q / fine_q), order, 0.05);
  EXPECT_NEAR(std::log2(coarse_z / fine_z), order, 0.05);
  OscillatorRun run = family_run(name, numbers, {}, 1.0, 0.0);
  EXPECT_EQ(run.layout.order, static_cast<int>(order));
}

/// One stage at position level, then a projection and the solve at the accepted state; a step that does not converge
/// ends there.
inline void expect_one_projected_stage(const std::string& name) {
  OscillatorRun run = family_run(name, {}, {}, 1.0, 0.0);
  run.t = 3.0;
  const int before = run.oscillator.accelerations;
  run.step(0.5);
  ASSERT_EQ(run.oscillator.stages.size(), 1u);
  EXPECT_EQ(run.oscillator.stages[0].level, ConstraintLevel::position);
  EXPECT_EQ(run.oscillator.stages[0].t, 3.5);
  EXPECT_EQ(run.oscillator.guesses[0], -1.0);  // a at the start of the step
  EXPECT_EQ(run.oscillator.projections, 1);
  EXPECT_EQ(run.oscillator.accelerations, before + 1);

  OscillatorRun failing = family_run(name, {}, {.stages_to_converge = 0}, 1.0, 0.0);
  EXPECT_EQ(failing.step(0.1).converged, 0);
  EXPECT_EQ(failing.oscillator.projections, 0);
}

/// Errors fall with the square of the steps where these are alternately short and long: the auxiliary acceleration
/// belongs to an instant that depends on the step.
inline void expect_order_with_varying_steps(const std::string& name, const Numbers& numbers) {
  const auto error = [&](int pairs) {
    OscillatorRun run = family_run(name, numbers, {.decay = 0.7}, 1.0, 0.3, 2.0);
    for (int i = 0; i < pairs; ++i) {
      run.step(1.0 / (3.0 * pairs));
      run.step(2.0 / (3.0 * pairs));
    }
    return std::array{run.q[0] - (std::cos(1.0) + 0.3 * std::sin(1.0)),
                      run.v[0] - (0.3 * std::cos(1.0) - std::sin(1.0)), run.z[0] - 2.0 * std::exp(-0.7)};
  };
  const auto coarse = error(200), fine = error(400);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(std::log2(coarse[i] / fine[i]), 2.0, 0.1) << i;
}

inline void expect_newton_parameters(const std::string& name) {
  const IntegratorInstance integrator(
      component(freeplay_plugin_v1_solvers, name),
      family_parameters(name, {{"newton.tolerance", 1e-8}, {"newton.max_iterations", 7}}));
  IntegratorLayout layout;
  layout.sizes = {7, 6, 2, 3};
  integrator.call(&abi::IntegratorTable::declare, &layout);
  EXPECT_EQ(layout.memory, 13);        // A, Z, z', the last step
  EXPECT_EQ(layout.scratch, 40 + 75);  // q, twice v, increment (or a) and z; what the error estimate needs
  EXPECT_EQ(layout.error_estimate, 1u);
  EXPECT_EQ(layout.newton_tolerance, 1e-8);
  EXPECT_EQ(layout.newton_max_iterations, 7);
}

/// The entry of a component's table.
inline const Parameter& integrator_parameter(const std::string& component_name, const std::string& name) {
  for (const Parameter& p : component(freeplay_plugin_v1_solvers, component_name).description.parameters)
    if (name == p.name) return p;
  throw std::runtime_error("no parameter " + name);
}

}  // namespace freeplay::test
