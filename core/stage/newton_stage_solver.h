// NewtonStageSolver: what the SDK's StageSolver calls; Newton's method on the equations of a stage.
//
// A stage asks for (a, lambda) with v = V + beta_v a, q = retract(q_n, D + beta_q a) and
//   [ M - beta_v f_v - beta_q f_q   Phi_q^T ] [ da      ]     [ M a + Phi_q^T lambda - f ]
//   [ Phi_q                         0       ] [ dlambda ] = - [ Phi / beta_q             ]
// (Bottasso, Dopico and Trainelli 2008: scaled like this the matrix does not depend on the step for small steps).
// d(Phi_q^T lambda)/dq is left out: it is beta_q lambda s against an inertia, and costs contraction, not accuracy.
// The Jacobian is kept over stages and steps, one for each pair of betas, while the iteration contracts (modified
// Newton). ConvergenceParameters say when an iteration stops.
#pragma once

#include <span>
#include <vector>

#include "freeplay/integrator.h"
#include "stage/convergence_monitor.h"
#include "stage/equations.h"
#include "stage/factor_cache.h"
#include "stage/flows.h"
#include "stage/index_one_solver.h"
#include "stage/local_error.h"
#include "stage/rounding_floor.h"
#include "system/system.h"

namespace freeplay {

class NewtonStageSolver {
 public:
  /// `run`: of the run that it solves for, or null; must outlive it.
  NewtonStageSolver(const System& system, const ConvergenceParameters& parameters, EvaluationContext* run = nullptr);

  const System& system() const { return system_; }
  const abi::StageSolverTable& table() const { return table_; }
  /// h of the states handed in from now on; views must stay valid.
  void use_history(std::span<const double> h) { equations_.use_history(h); }

  /// See StageSolver. False, with fault() or trouble(), where an element fails.
  bool solve(const Stage& stage, StateView& out, StageResult& result);
  /// See StageSolver::guess_error.
  double guess_error() const { return monitor_.predictor_error(); }
  /// See StageSolver::unsolved_error, at the present evaluation. Counts the stage.
  double unsolved_error(double beta_q, double beta_v, std::span<const double> missed);
  bool project_velocity(StateView& state) { return index_one_.project_velocity(state); }
  /// Multipliers mu of the last project_velocity(): the impulse on the bodies was -Phi_q^T mu [N s, N m s].
  std::span<const double> impulse() const { return index_one_.impulse(); }
  bool project_position(StateView& state) { return index_one_.project_position(state); }
  /// Index-1 system; redundant multipliers come out with driver efforts, then reactions, of least norm.
  bool accelerate(StateView& state, Span<double> z_rate) { return index_one_.accelerate(state, z_rate); }

  /// From now on attempts return their error in these units, see LocalError::allow().
  void control_error(double position, double velocity, double relative) {
    local_error_.allow(position, velocity, relative);
    table_.estimates = position > 0.0 ? 1 : 0;
  }
  LocalError& local_error() { return local_error_; }
  const LocalError& local_error() const { return local_error_; }
  double error_norm(std::span<const double> position, std::span<const double> velocity) {
    return local_error_.norm(position, velocity);
  }
  double internal_error_norm(double dt, const StateView& end, std::span<const double> error) {
    return local_error_.internal_norm(dt, end, error);
  }
  /// accelerate() appends the rates of `flows` to z'; z of the states handed in then has as many numbers more.
  void integrate_flows(const Flows& flows) { index_one_.integrate_flows(&flows); }
  /// 3 x 3: acceleration of a joint's second marker relative to its first per unit force between them, world axes.
  bool mobility(const State& state, int joint, std::span<double> out, std::span<double> whole) {
    return index_one_.mobility(state, joint, out, whole);
  }

  /// The states to come are not close to the last one: factors are made anew there.
  void move_away() { index_one_.move_away(); }
  /// The equations where they were evaluated last.
  KeptEvaluation& evaluation() { return equations_.evaluation(); }
  /// Why the last call failed: an element's fault, or kind none with `trouble()`.
  const Fault& fault() const { return equations_.fault(); }
  const char* trouble() const { return equations_.trouble(); }
  /// Row with the largest position residual when the last stage gave up, or -1.
  int worst_row() const { return worst_row_; }
  long iterations() const { return iterations_; }
  long factorizations() const { return factors_.factorizations() + index_one_.factorizations(); }
  IndependentRows& rows() { return equations_.rows(); }
  /// See IndependentRows::regularity().
  double regularity() const { return equations_.rows().regularity(); }

  /// All else is of one stage, or follows from the model.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.equations_, self.index_one_, self.factors_, self.floor_, self.monitor_, self.local_error_);
    archive(self.iterations_, self.worst_row_);
  }

 private:
  StageFactor& begin_stage(const Stage& stage, StateView& out, StageResult& result);
  /// Coordinates, velocities and internal variables of a stage at the accelerations that `out` has.
  void follow_accelerations(const Stage& stage, StateView& out);
  bool evaluate(const Stage& stage, const StateView& at, bool with_jacobian);
  /// Factors at the present evaluation, which must hold Phi_q and derivatives.
  [[gnu::noinline]] bool refactor(StageFactor& factor);
  void solve_linear(StageFactor& factor, std::span<double> update);
  [[gnu::noinline]] bool find_dependent_rows();
  /// right_ <- minus the residuals.
  void fill_right_side(const Stage& stage, const StateView& out, StageFactor& factor, bool first);
  /// The part of the constraint equations at position level: rounding and drift removed.
  void fill_position_residual(double beta_q);
  void fill_velocity_residual(double beta_v, const StateView& out);
  /// Adds the update to the unknowns. Returns what it says of the iteration.
  Convergence apply_update(const Stage& stage, StateView& out, StageFactor& factor, bool first);
  /// Whether the internal variables are within their tolerance after the update.
  bool update_internal(const Stage& stage, const StateView& out, StageFactor& factor);
  void update_unknowns(StateView& out, StageFactor& factor);
  /// Rounding accumulates as constraint drift, in every stage. Accelerations that mend all of it would be large in
  /// short steps, and wrong in the next: they take the part of one stage, and once the stage is solved positions alone
  /// are moved back by the rest (drift_).
  bool has_drifted(StageFactor& factor, bool on_phi) const;
  [[gnu::noinline]] void correct_drift(StageFactor& factor, StateView& out);
  /// Whether the last update is nothing but amplified rounding of Phi: near a singular position it grows without bound,
  /// and further iterations do not reduce it.
  [[gnu::noinline]] bool is_rounding_of_phi(const Stage& stage, StageFactor& factor);
  /// The first redundant equation that does not hold by itself, or -1.
  int violated_redundant_row(const Stage& stage) const;
  [[gnu::noinline]] int row_of_largest_residual() const;
  bool accept(StateView& out, StageResult& result);
  /// A stage that did not converge: a result, not a fault.
  bool give_up(const char* trouble, int worst_row = -1);

  const System& system_;
  abi::StageSolverTable table_;
  StageEquations equations_;
  IndexOneSolver index_one_;
  FactorCache factors_;
  RoundingFloor floor_;
  ConvergenceMonitor monitor_;
  LocalError local_error_;
  std::vector<double> right_, update_, increment_, z_rate_, largest_z_rate_, work_;
  bool drifted_ = false;       // the present stage began with drift
  std::vector<double> drift_;  // increment that takes it back
  long iterations_ = 0;
  int worst_row_ = -1;
};

}  // namespace freeplay
