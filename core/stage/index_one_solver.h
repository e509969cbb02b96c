// IndexOneSolver: the equations of motion where time, coordinates and velocities are given,
//
//   [ M      Phi_q^T ] [ a      ]   [ f     ]
//   [ Phi_q  0       ] [ lambda ] = [ gamma ]
//
// and what else their matrix gives: projections on the constraints and the mobility of joints.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "freeplay/integrator.h"
#include "stage/acceleration_matrix.h"
#include "stage/convergence_parameters.h"
#include "stage/equations.h"
#include "stage/flows.h"
#include "stage/rounding_floor.h"
#include "system/system.h"

namespace freeplay {

class IndexOneSolver {
 public:
  IndexOneSolver(StageEquations& equations, const ConvergenceParameters& parameters);

  /// Redundant multipliers come out with driver efforts, then reactions, of least norm. Factors are those of the very
  /// position, so that the same state always has the same accelerations.
  bool accelerate(StateView& state, Span<double> z_rate);
  /// accelerate() appends the rates of `flows` to z' from now on. Returns whose rates it appended before.
  const Flows* integrate_flows(const Flows* flows) { return std::exchange(flows_, flows); }
  bool project_velocity(StateView& state);
  /// Multipliers mu of the last project_velocity(): the impulse on the bodies was -Phi_q^T mu [N s, N m s].
  std::span<const double> impulse() const { return multipliers_; }
  bool project_position(StateView& state);
  /// JointInput::mobility and, unless `whole` is empty, JointInput::whole_mobility.
  bool mobility(const State& state, int joint, std::span<double> out, std::span<double> whole);
  /// The states to come are not close to the last one: factors are made anew there.
  void move_away() { valid_ = false; }
  /// Looks for redundant rows at the present evaluation, unless that was done before.
  void know_rows();

  /// `along` <- the part of `error` along the motion, where the attempt came close to a singular position. False
  /// elsewhere.
  bool part_along_motion(std::span<const double> error, std::span<double> along);

  long factorizations() const { return factorizations_; }

  /// restore() expects the choice of rows.
  void save(ArchiveWriter& archive) const;
  void restore(ArchiveReader& archive);

 private:
  void set_pattern();
  bool is_rounded(double gap);
  bool factor();
  double factor_once();
  /// The factors are of the rows that are kept at present.
  bool has_factors() const { return valid_ && pattern_choice_ == equations_.rows().choice(); }
  /// Iterates x += A0^-1 (b - A x) at the present evaluation, b in (right_a_, right_c_), until x_a is right to
  /// rounding, of itself or of `scale`, and with `multipliers` x_c, too. `solved`: update_ is the first one already.
  bool refine(std::span<double> x_a, std::span<double> x_c, double scale, bool multipliers = false,
              bool solved = false);
  void solve_linear(std::span<double> x, std::span<double> l);
  /// update_ <- A0^-1 (b - A x)
  void solve_remainder(std::span<const double> x_a, std::span<const double> x_c);
  /// Returns how large the update is, relative; NaN where it is not finite.
  double add_update(std::span<double> x_a, std::span<double> x_c, double scale, bool multipliers);
  bool accelerations_by_units(int joint, std::span<const std::size_t> directions, const double* arm, std::size_t width,
                              std::span<double> out);
  bool move_by_forces();
  /// Whether every equation holds as well as its terms are rounded (Oettli and Prager 1964), and parts of it; the
  /// second with the right sides `right`, to so many roundings.
  bool holds_to_rounding(std::span<const double> x_a, std::span<const double> x_c);
  template <int width>
  bool equations_hold(std::span<const double> x_a, std::span<const double> x_c);
  template <int width>
  bool rows_hold_in(std::span<const double> right, std::span<const double> x_a, double tolerance,
                    std::span<double> left);
  bool rows_hold(std::span<const double> right, std::span<const double> x_a, double tolerance, std::span<double> left);
  /// The same for Phi_q v = nu; leaves what is missing in right_c_.
  bool velocities_hold(std::span<const double> v);
  /// The factors are those of the present evaluation.
  bool is_factored_here() const;
  void solve_rows(std::span<const double> gap);

  StageEquations& equations_;
  const System& system_;
  KeptEvaluation& e_;                // of equations_
  std::span<const char> dependent_;  // IndependentRows::dependent() of equations_
  const ConvergenceParameters parameters_;
  RoundingFloor floor_;
  AccelerationMatrix matrix_;
  bool valid_ = false;               // its factors
  int pattern_choice_ = -1;          // IndependentRows::choice() of its pattern
  double factored_time_ = 0.0;       // of its factors
  std::vector<double> factored_at_;  // their coordinates
  std::vector<double> update_, increment_, right_a_, right_c_, work_, size_;
  std::vector<double> multipliers_, first_multipliers_;
  std::vector<double> loads_;  // multipliers with those of driven bodies
  bool drifts_ = true;         // the last position projection had something to move
  long factorizations_ = 0;
  const Flows* flows_ = nullptr;
};

}  // namespace freeplay
