// NewtonStageSolver: the implementation behind the SDK's StageSolver.
//
// A stage asks for (a, lambda) with v = V + beta_v a, q = retract(q_n, D + beta_q a) and
//   [ M - beta_v f_v - beta_q f_q   Phi_q^T ] [ da      ]     [ M a + Phi_q^T lambda - f ]
//   [ Phi_q                         0       ] [ dlambda ] = - [ Phi / beta_q             ]
// (Bottasso, Dopico and Trainelli 2008: scaled like this the matrix does not depend on the step for small steps).
// d(Phi_q^T lambda)/dq is left out: it is beta_q lambda s against an inertia, and costs contraction, not accuracy.
// Factors are kept over stages and steps, one for each pair of betas, while the iteration contracts.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "freeplay/integrator.h"
#include "stage/equations.h"
#include "stage/flows.h"
#include "stage/index_one_solver.h"
#include "stage/matrix.h"
#include "system/system.h"

namespace freeplay {

struct StageOptions {
  /// Largest position error left by a stage, in model sizes [1], and per second that in velocity; where the step itself
  /// errs much, so much in velocity that 5000 such steps together move by it.
  double tolerance = 1e-10;
  int max_iterations = 20;
};

class NewtonStageSolver {
 public:
  NewtonStageSolver(const System& system, const StageOptions& options);

  const abi::StageSolverTable& table() const { return table_; }
  /// h of the states handed in from now on; views must stay valid.
  void use_history(std::span<const double> h) { equations_.use_history(h); }

  bool solve(const Stage& stage, StateView& out, StageResult& result);
  /// See StageSolver::unsolved_error, at the present evaluation. Counts the stage.
  double unsolved_error(double beta_q, double beta_v, std::span<const double> missed);
  bool project_velocity(StateView& state) { return index_one_.project_velocity(state); }
  /// Multipliers mu of the last project_velocity(): the impulse on the bodies was -Phi_q^T mu [N s, N m s].
  std::span<const double> impulse() const { return index_one_.impulse(); }
  bool project_position(StateView& state) { return index_one_.project_position(state); }
  /// Index-1 system; redundant multipliers come out with driver efforts, then reactions, of least norm.
  bool accelerate(StateView& state, Span<double> z_rate) { return index_one_.accelerate(state, z_rate); }

  /// From now on attempts return their error in units of `position` [m], angles by the model's size, and in velocity of
  /// `velocity` [m/s] plus the part `relative` of the largest velocity.
  void control_error(double position, double velocity, double relative) {
    allowed_ = position, allowed_slow_ = velocity, allowed_part_ = relative;
    table_.estimates = position > 0.0 ? 1 : 0;
  }
  /// The velocities at the start of the attempt. Their rounding is no error.
  void use_velocity(std::span<const double> v) {
    equations_.rows().begin_attempt();
    allowed_rate_ = allowed_slow_ + std::max(allowed_part_, 2e-14) * system_.size() * equations_.norm(v);
  }
  double error_norm(std::span<const double> position, std::span<const double> velocity);
  double velocity_error(std::span<const double> velocity) { return part_of_allowed(velocity, allowed_rate_); }
  double internal_error_norm(double dt, const StateView& end, std::span<const double> error);
  /// Index into v of the largest part of the last error_norm().
  int worst_component() const { return worst_component_; }
  /// accelerate() appends the rates of `flows` to z'; z of the states handed in then has as many numbers more.
  void integrate_flows(const Flows& flows) { index_one_.integrate_flows(&flows); }
  /// 3 x 3: acceleration of a joint's second marker relative to its first per unit force between them, world axes.
  bool mobility(const State& state, int joint, std::span<double> out) { return index_one_.mobility(state, joint, out); }

  /// The states to come are not close to the last one: factors are made anew there.
  void move_away() { index_one_.move_away(); }
  /// The equations where they were looked at last.
  KeptEvaluation& evaluation() { return e_; }
  /// Why the last call failed: an element's fault, or kind none with `trouble()`.
  const Fault& fault() const { return equations_.fault(); }
  const char* trouble() const { return equations_.trouble(); }
  /// Row with the largest position residual when the last stage gave up, or -1.
  int worst_row() const { return worst_row_; }
  long iterations() const { return iterations_; }
  long factorizations() const { return factorizations_ + index_one_.factorizations(); }
  /// Smallest pivot of the index-1 matrix in the present attempt, or in the last that had one, in parts of its largest
  /// value in the run. It falls with the square of the distance from a singular position of the constraints.
  double regularity() const { return equations_.rows().regularity(); }
  /// Row that comes closest to depending on the others where the equations were looked at last, or -1. Slow.
  int weakest_row() { return equations_.rows().weakest(e_); }

 private:
  struct Factor {
    StageMatrix matrix;
    double beta_q = 0.0, beta_v = 0.0, beta_z = 0.0;
    long used = -1;
    bool valid = false, has_pattern = false;
    double contraction = 1.0;  // of the iteration, seen last; 1: not seen with these forces
    int since_seen = 0;        // stages
    int stays = 0;             // iterations since the factors were made that did not shrink at the size of roundings
    double noise = 0.0;        // of accelerations, with new factors
    int since_noise = 0;       // stages
    std::uint64_t acting = 0;  // Evaluation::acting
    int held = 0;              // stages since a guess was off the rows
  };

  Factor& factor_for(double beta_q, double beta_v);
  /// Factor at the present evaluation, which must hold Phi_q and derivatives.
  bool refactor(Factor& factor);
  void set_pattern(Factor& factor);
  double factor_once(Factor& factor);
  bool find_dependent_rows();
  void note_rounding_of_phi();
  void note_turns();
  void follow_choice_of_rows();
  /// Largest error in units of `allowed`, a length or its rate. Close to a singular position of the constraints the
  /// part along the motion counts; the part across is taken away when the end of the step is projected, up to its
  /// square over the size of the model.
  double part_of_allowed(std::span<const double> error, double allowed);
  /// Velocities, coordinates and internal variables of a stage at the accelerations that `out` has.
  void follow_accelerations(const Stage& stage, StateView& out);
  /// Whether the last update of a stage is what the rounding of Phi makes of itself: close to a singular position it
  /// grows without bound, and nothing more can be won.
  bool is_rounding_of_phi(const Factor& factor, double way, bool drifted);
  /// Whether Phi is no more than its roundings, or so many times as much.
  bool rows_hold(double times = 1.0) const;
  /// right_ of the rows: what of Phi is more than rounding, and not drift.
  void ask_for_rows(double beta_q, bool drifted);
  /// Positions leave the constraints by some roundings more in every stage, until more than roundings have come
  /// together. Accelerations that mend all of it would be large in short steps, and wrong in the next: they learn the
  /// part of one stage, and once the stage is solved positions alone are moved back by the rest (drift_).
  bool is_drift(Factor& factor, bool held) const;
  void learn_drift(Factor& factor, StateView& out);

  const System& system_;
  StageOptions options_;
  abi::StageSolverTable table_;
  StageEquations equations_;
  IndexOneSolver index_one_;
  KeptEvaluation& e_;            // of equations_
  std::vector<Factor> factors_;  // one for each pair of betas
  int choice_of_rows_ = 0;       // that they were made with
  std::vector<double> right_, update_, increment_, drift_, z_rate_, work_;
  std::vector<double> quiet_phi_;  // by row: below, Phi is rounding
  double coarse_ = 1.0;            // roundings of the largest coordinate, in those of units
  struct CoordinateTerm {
    std::size_t row, joint;
    double factor;
  };
  std::vector<CoordinateTerm> coordinate_terms_;                       // of rows of gears and drivers
  std::vector<double> other_a_, other_lambda_, other_z_, other_rate_;  // of internal_error_norm()
  long clock_ = 0, iterations_ = 0, factorizations_ = 0;
  double guess_error_ = 0.0;  // first update of the last stage, in parts of what it may leave
  double allowed_ = 0.0, allowed_slow_ = 0.0, allowed_part_ = 0.0, allowed_rate_ = 0.0;
  int worst_row_ = -1, worst_component_ = -1;
};

}  // namespace freeplay
