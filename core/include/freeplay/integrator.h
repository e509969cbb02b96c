// Integrator: turns one time step into a few nonlinear stages. The host solves the stages.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>

#include "freeplay/parameter.h"

namespace freeplay {

/// One state of the model. Views into a single block owned by the host.
struct StateView {
  double* t;            ///< [s]
  Span<double> q;       ///< coordinates, nq
  Span<double> v;       ///< velocities, nv (tangent space, so nv may be less than nq)
  Span<double> a;       ///< accelerations, nv
  Span<double> lambda;  ///< constraint multipliers, nc; the force on the bodies is -Phi_q^T lambda
  Span<double> z;       ///< internal variables of the joints, nz
  Span<double> memory;  ///< this integrator's numbers that live from step to step
};

enum class ConstraintLevel : std::uint32_t { position, velocity };

/// One implicit stage. With the unknown acceleration a and internal rate z':
///   v = v_known + beta_v a,   q = retract(q_base, increment_known + beta_q a),   z = z_known + beta_z z',
///   M(q) a + Phi_q^T lambda = f(t,q,v,z) together with the constraints at `level`.
/// The known terms must not alias the state being solved for.
struct Stage {
  double t;
  Span<const double> q_base, increment_known, v_known, z_known;
  double beta_q, beta_v, beta_z;
  ConstraintLevel level;
};

struct StageResult {
  std::int32_t converged;  ///< 0 or 1
  std::int32_t iterations;
};

namespace abi {
struct StageSolverTable {
  std::uint32_t size;
  void* self;
  Status (*solve)(void*, const Stage*, StateView*, StageResult*, Message*) noexcept;
  Status (*project_velocity)(void*, StateView*, Message*) noexcept;
  Status (*project_position)(void*, StateView*, Message*) noexcept;
  Status (*accelerate)(void*, StateView*, Span<double> z_rate, Message*) noexcept;
  // Appended. `estimates`: nonzero when the run controls its steps by Attempt::error.
  double (*error_norm)(void*, Span<const double> position, Span<const double> velocity) noexcept;
  void (*retract)(void*, Span<const double> q_base, Span<const double> increment, Span<double> q) noexcept;
  std::uint32_t estimates;
  double (*internal_error_norm)(void*, double dt, const StateView* end, Span<const double> error) noexcept;
  void (*increment_rate)(void*, Span<const double> increment, Span<const double> v, Span<double> rate) noexcept;
  double (*guess_error)(void*) noexcept;
  double (*unsolved_error)(void*, double beta_q, double beta_v, Span<const double> missed) noexcept;
};
}  // namespace abi

/// What an integrator may ask of the model; assembly, Newton and linear algebra stay in the host.
class StageSolver {
 public:
  explicit StageSolver(const abi::StageSolverTable& table) : table_(&table) {}

  /// Solves a stage; `out.a` and `out.lambda` are the starting guess. Leaves t, q, v, a, lambda, z of the stage in
  /// `out`. A stage that does not converge is a result, not an error.
  StageResult solve(const Stage& stage, StateView& out) {
    StageResult result{};
    Message message;
    abi::require(table_->solve(table_->self, &stage, &out, &result, &message), message);
    return result;
  }
  /// How far the starting guess of the last solve() was off: the first update of the iteration, in parts of what a
  /// stage may leave (newton_tolerance). Infinite where the host gives none.
  double guess_error() const {
    return table_->guess_error != nullptr ? table_->guess_error(table_->self) : std::numeric_limits<double>::infinity();
  }
  /// Error of a stage with these betas that was left as predicted and that accelerate() has evaluated last, in parts of
  /// newton_tolerance, which any stage may leave. `missed` [m/s^2, rad/s^2], nv numbers: by how much its accelerations
  /// differ from the predicted ones. Infinite where positions are off the constraints by more than roundings, or the
  /// host gives none.
  double unsolved_error(double beta_q, double beta_v, Span<const double> missed) const {
    if (table_->unsolved_error == nullptr) return std::numeric_limits<double>::infinity();
    return table_->unsolved_error(table_->self, beta_q, beta_v, missed);
  }
  /// v <- v - M^-1 Phi_q^T mu with Phi_q v = nu: returns v to the constraints, least in the mass norm.
  void project_velocity(StateView& state) {
    Message message;
    abi::require(table_->project_velocity(table_->self, &state, &message), message);
  }
  /// The same for q and Phi = 0, repeated until it holds. For explicit methods.
  void project_position(StateView& state) {
    Message message;
    abi::require(table_->project_position(table_->self, &state, &message), message);
  }
  /// Fills a, lambda (index-1 system) and z_rate at given t, q, v, z.
  void accelerate(StateView& state, Span<double> z_rate) {
    Message message;
    abi::require(table_->accelerate(table_->self, &state, z_rate, &message), message);
  }
  /// Nonzero in runs that control their steps: attempts that have an estimate must then return it.
  bool estimates() const { return table_->estimates != 0; }
  /// Largest local error in units of what the run allows: `position` [m, rad] (an increment) and `velocity` [m/s,
  /// rad/s], nv numbers each. At most 1 is acceptable. 0 in runs that do not control their steps.
  double error_norm(Span<const double> position, Span<const double> velocity) const {
    return table_->error_norm(table_->self, position, velocity);
  }
  /// The same for local errors of internal variables, nz numbers: their units are the joints', so each counts as the
  /// velocity that it is about to change, by the other accelerations that it makes, in one more step of length `dt`
  /// from `end` (where a and lambda are solved).
  double internal_error_norm(double dt, const StateView& end, Span<const double> error) const {
    if (error.empty() || table_->internal_error_norm == nullptr) return 0.0;
    return table_->internal_error_norm(table_->self, dt, &end, error);
  }
  /// q = retract(q_base, increment); for methods that make their own stages.
  void retract(Span<const double> q_base, Span<const double> increment, Span<double> q) const {
    table_->retract(table_->self, q_base, increment, q);
  }
  /// Rate d' of the increment d of such a stage at its velocities v: v itself but for rotations in space, where
  /// d' = v + d x v/2 + ...; methods above order 2 need it.
  void increment_rate(Span<const double> increment, Span<const double> v, Span<double> rate) const {
    if (table_->increment_rate != nullptr) return table_->increment_rate(table_->self, increment, v, rate);
    std::copy(v.begin(), v.end(), rate.begin());
  }

 private:
  const abi::StageSolverTable* table_;
};

struct Sizes {
  std::int32_t nq, nv, nc, nz;
};

/// Work space that the host reserves, so that stepping never allocates.
struct IntegratorLayout {
  std::uint32_t size = sizeof(IntegratorLayout);
  Sizes sizes{};                     ///< in
  std::int32_t memory = 0;           ///< numbers kept between accepted steps; part of the state
  std::int32_t scratch = 0;          ///< numbers valid within one attempt
  std::int32_t order = 1;            ///< of the local solution
  std::uint32_t error_estimate = 0;  ///< nonzero: Attempt::error means something
  double newton_tolerance = 1e-10;   ///< largest position error left by a stage, in model sizes
  std::int32_t newton_max_iterations = 20;
  // Appended.
  std::int32_t error_order = 0;       ///< power of dt with which the estimate falls; 0: order + 1
  std::uint32_t explicit_stages = 0;  ///< nonzero: accelerate() is all that it solves; the host may then hand it more z
  std::uint32_t always_adaptive = 0;  ///< nonzero: may not be run with fixed steps
};

/// The parameters of every implicit integrator; spread them into its table and copy them in declare().
inline constexpr Parameter newton_tolerance_parameter{
    .name = "newton.tolerance",
    .default_value = 1e-10,
    .minimum = 0.0,
    .open = Open::minimum,
    .summary = "Largest position error that the iteration of a stage may leave, relative to the size of the model."};
inline constexpr Parameter newton_iterations_parameter{
    .name = "newton.max_iterations",
    .kind = ParameterKind::integer,
    .default_value = 20,
    .minimum = 1,
    .summary = "Iterations after which a stage is given up and the step is halved."};

struct Attempt {
  std::int32_t converged;  ///< 0 or 1
  double error;            ///< weighted local error, <= 1 is acceptable; 0 without an estimate
};

/// Attempts steps; never accepts one. Immutable after construction.
class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual void declare(IntegratorLayout& layout) const = 0;
  /// Fills `memory` at the start of a run and after an event; a and lambda of the state are consistent.
  virtual void restart(StateView& /*state*/, StageSolver& /*solver*/) const {}
  /// Advances `to`, which enters as a copy of the accepted state, from t to t + dt.
  virtual Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const = 0;
};

namespace abi {
struct IntegratorTable {
  std::uint32_t size;
  void (*destroy)(void*) noexcept;
  Status (*declare)(const void*, IntegratorLayout*, Message*) noexcept;
  Status (*restart)(const void*, StateView*, const StageSolverTable*, Message*) noexcept;
  Status (*attempt)(const void*, double, StateView*, Span<double>, const StageSolverTable*, Attempt*,
                    Message*) noexcept;
};

template <class I>
inline constexpr IntegratorTable integrator_table{
    sizeof(IntegratorTable), [](void* s) noexcept { delete static_cast<I*>(s); },
    [](const void* s, IntegratorLayout* layout, Message* m) noexcept {
      return guarded(m, [&] { static_cast<const I*>(s)->declare(*layout); });
    },
    [](const void* s, StateView* state, const StageSolverTable* table, Message* m) noexcept {
      return guarded(m, [&] {
        StageSolver solver(*table);
        static_cast<const I*>(s)->restart(*state, solver);
      });
    },
    [](const void* s, double dt, StateView* to, Span<double> scratch, const StageSolverTable* table, Attempt* result,
       Message* m) noexcept {
      return guarded(m, [&] {
        StageSolver solver(*table);
        *result = static_cast<const I*>(s)->attempt(dt, *to, scratch, solver);
      });
    }};

template <class I>
Status create_integrator(const ParameterTable* table, void** self, Message* m) noexcept {
  return guarded(m, [&] { *self = std::make_unique<I>(Parameters(*table)).release(); });
}
}  // namespace abi
}  // namespace freeplay
