// The integrator suite finds what is wrong with an integrator, and nothing in one that is right.
#include "contract/integrator_contract.h"

#include <algorithm>
#include <limits>
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "findings_text.h"

namespace freeplay::test {
namespace {

const Conditions integrator_conditions{.seed = 1, .allocations = &allocations};

enum class MeanFlaw {
  none,
  first_order,
  slow_internal,
  stale_multipliers,
  pumps,
  drifts_at_rest,
  leaves_constraints,
  wrong_time,
  counts_attempts,
  remembers_failure,
  reads_scratch,
  hides_failure,
  restart_moves,
  throws,
  not_a_number,
  writes_beside_scratch,
  writes_beside_memory,
  allocates,
  error_without_estimate,
  no_order
};

/// Half a step of each end: a(n) and a(n+1), positions held, velocities projected, accelerations solved again.
class Mean final : public Integrator {
 public:
  explicit Mean(MeanFlaw flaw = MeanFlaw::none, double bias = 0.0) : flaw_(flaw), bias_(bias) {}

  void declare(IntegratorLayout& layout) const override {
    const Sizes& n = layout.sizes;
    layout.memory = n.nz;
    layout.scratch = n.nq + 2 * n.nv + n.nz;
    layout.order = flaw_ == MeanFlaw::no_order ? 0 : 2;
  }
  void restart(StateView& state, StageSolver& solver) const override {
    solver.accelerate(state, state.memory);
    if (flaw_ == MeanFlaw::restart_moves) state.v[0] += 1e-12;
  }
  Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const override {
    break_before(to, scratch);
    if (!stage(dt, to, scratch, solver)) {
      if (flaw_ == MeanFlaw::remembers_failure) hidden_ += 1e-12;
      if (flaw_ != MeanFlaw::hides_failure) return {0, 0.0};
    }
    if (flaw_ != MeanFlaw::leaves_constraints) solver.project_velocity(to);
    const double first = to.lambda.empty() ? 0.0 : to.lambda[0];
    solver.accelerate(to, to.memory);
    if (flaw_ == MeanFlaw::stale_multipliers && !to.lambda.empty()) to.lambda[0] = first;
    to.v[0] += bias_ + hidden_;
    break_after(dt, to);
    return {1, flaw_ == MeanFlaw::error_without_estimate ? 0.5 : 0.0};
  }

 private:
  bool stage(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const {
    const std::size_t nq = to.q.size, nv = to.v.size, nz = to.z.size;
    const Span<double> q = scratch.part(0, nq), v = scratch.part(nq, nv), d = scratch.part(nq + nv, nv),
                       z = scratch.part(nq + 2 * nv, nz);
    // Weight of the old end; the other end has the rest.
    const double old = flaw_ == MeanFlaw::first_order ? 0.0 : 0.5, b = (1.0 - old) * dt;
    const double old_z = flaw_ == MeanFlaw::slow_internal ? 0.0 : 0.5, b_z = (1.0 - old_z) * dt;
    std::copy(to.q.begin(), to.q.end(), q.begin());
    for (std::size_t i = 0; i < nv; ++i) {
      v[i] = to.v[i] + old * dt * to.a[i];
      d[i] = old * dt * to.v[i] + b * v[i];
    }
    for (std::size_t i = 0; i < nz; ++i) z[i] = to.z[i] + old_z * dt * to.memory[i];
    const Stage stage{*to.t + dt, q, d, v, z, b * b, b, b_z, ConstraintLevel::position};
    return solver.solve(stage, to).converged != 0;
  }
  void break_before(StateView& to, Span<double> scratch) const {
    if (flaw_ == MeanFlaw::reads_scratch) to.v[0] += 1e-12 * scratch[0];
    if (flaw_ == MeanFlaw::writes_beside_scratch) scratch.data[scratch.size] = 0.0;
    if (flaw_ == MeanFlaw::counts_attempts) hidden_ += 1e-13;
    if (flaw_ == MeanFlaw::throws) throw std::runtime_error("no step today");
    if (flaw_ == MeanFlaw::allocates) ::operator delete(::operator new(8));
  }
  void break_after(double dt, StateView& to) const {
    if (flaw_ == MeanFlaw::pumps) {
      for (double& x : to.v) x *= 1.0 + 1e-4;
    }
    if (flaw_ == MeanFlaw::drifts_at_rest) to.q[2] += 1e-11;
    if (flaw_ == MeanFlaw::wrong_time) *to.t += 1e-6 * dt;
    if (flaw_ == MeanFlaw::not_a_number) to.a[0] = std::numeric_limits<double>::quiet_NaN();
    if (flaw_ == MeanFlaw::writes_beside_memory) to.memory.data[to.memory.size] = 0.0;
  }
  MeanFlaw flaw_;
  double bias_;
  mutable double hidden_ = 0.0;
};

IntegratorRef ref_of(const Mean& integrator) { return {abi::integrator_table<Mean>, &integrator}; }
Findings judge(MeanFlaw flaw) {
  const Mean integrator(flaw), twin(flaw);
  return check_integrator({ref_of(integrator), ref_of(twin)}, integrator_conditions);
}

TEST(IntegratorContract, HoldsForASoundIntegrator) {
  EXPECT_TRUE(judge(MeanFlaw::none).held()) << broken_rules(judge(MeanFlaw::none));
}

TEST(IntegratorContract, FindsEveryFlaw) {
  const struct {
    MeanFlaw flaw;
    const char* rule;
  } cases[] = {{MeanFlaw::first_order, "order-position"},
               {MeanFlaw::first_order, "order-velocity"},
               {MeanFlaw::slow_internal, "order-internal"},
               {MeanFlaw::stale_multipliers, "order-multiplier"},
               {MeanFlaw::pumps, "energy"},
               {MeanFlaw::drifts_at_rest, "rest"},
               {MeanFlaw::leaves_constraints, "constraints"},
               {MeanFlaw::wrong_time, "time"},
               {MeanFlaw::counts_attempts, "repeatable"},
               {MeanFlaw::remembers_failure, "repeatable"},
               {MeanFlaw::reads_scratch, "repeatable"},
               {MeanFlaw::hides_failure, "reports-failure"},
               {MeanFlaw::restart_moves, "restart"},
               {MeanFlaw::throws, "answers"},
               {MeanFlaw::not_a_number, "finite"},
               {MeanFlaw::writes_beside_scratch, "stays-in-span"},
               {MeanFlaw::writes_beside_memory, "stays-in-span"},
               {MeanFlaw::allocates, "allocation"},
               {MeanFlaw::error_without_estimate, "error-estimate"},
               {MeanFlaw::no_order, "declares-sanely"}};
  for (const auto& [flaw, rule] : cases) {
    const Findings findings = judge(flaw);
    EXPECT_TRUE(findings.broken(rule)) << rule << " is not reported, but\n" << broken_rules(findings);
  }
}

TEST(IntegratorContract, FindsTwinsThatDiffer) {
  const Mean integrator, twin(MeanFlaw::none, 1e-12);
  EXPECT_TRUE(check_integrator({ref_of(integrator), ref_of(twin)}, integrator_conditions).broken("same-twin"));
}

}  // namespace
}  // namespace freeplay::test
