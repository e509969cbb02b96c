// IndexOneSolver: the equations of motion where time, coordinates and velocities are given,
//
//   [ M      Phi_q^T ] [ a      ]   [ f     ]
//   [ Phi_q  0       ] [ lambda ] = [ gamma ]
//
// and what else their matrix gives: projections on the constraints and the mobility of joints. It knows which rows the
// others determine.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "freeplay/integrator.h"
#include "linear/row_rank.h"
#include "stage/acceleration_matrix.h"
#include "stage/flows.h"
#include "system/system.h"

namespace freeplay {

class IndexOneSolver {
 public:
  static constexpr double singular_pivot = 1e-13;  ///< smallest pivot over the largest
  static constexpr double slow_contraction = 0.1;  ///< stale factors that contract less are renewed

  IndexOneSolver(const System& system, int max_iterations);

  /// h of the states handed in from now on; views must stay valid.
  void use_history(std::span<const double> h) { h_ = h; }
  bool evaluate(const StateView& at, unsigned terms);
  /// The equations where they were looked at last.
  KeptEvaluation& evaluation() { return e_; }

  /// Redundant multipliers come out with driver efforts, then reactions, of least norm. Factors are those of the very
  /// position, so that the same state always has the same accelerations.
  bool accelerate(StateView& state, Span<double> z_rate);
  /// accelerate() appends the rates of `flows` to z' from now on. Returns whose rates it appended before.
  const Flows* integrate_flows(const Flows* flows) { return std::exchange(flows_, flows); }
  bool project_velocity(StateView& state);
  /// Multipliers mu of the last project_velocity(): the impulse on the bodies was -Phi_q^T mu [N s, N m s].
  std::span<const double> impulse() const { return multipliers_; }
  bool project_position(StateView& state);
  /// 3 x 3: acceleration of a joint's second marker relative to its first per unit force between them, world axes.
  bool mobility(const State& state, int joint, std::span<double> out);
  /// The states to come are not close to the last one: factors are made anew there.
  void move_away() { valid_ = false; }

  /// The rows that others determine are marked. They have been looked for after know_rows() or the first factors.
  std::span<const char> dependent() const { return dependent_; }
  bool any_dependent() const { return any_dependent_; }
  /// Grows whenever others than before are marked.
  int choice_of_rows() const { return choice_of_rows_; }
  void know_rows();
  /// Looks at the present evaluation. Returns whether others than before are marked.
  bool find_dependent_rows();
  /// Row that comes closest to depending on the others where the equations were looked at last, or -1. Slow.
  int weakest_row();

  /// Smallest pivot in the present attempt, or in the last that had one, in parts of its largest value in the run. It
  /// falls with the square of the distance from a singular position of the constraints.
  double regularity() const { return regularity_ < 1.0 ? regularity_ : last_regularity_; }
  void begin_attempt() { regularity_ = 1.0; }
  /// `along` <- the part of `error` along the motion, where the attempt came close to a singular position. False
  /// elsewhere.
  bool part_along_motion(std::span<const double> error, std::span<double> along);

  /// Largest increment, lengths in model sizes; keeps a NaN.
  double norm(std::span<const double> increment) const;
  std::span<const double> units() const { return unit_; }  ///< of increments: 1 for angles, else the model's size

  /// Why the last call failed: an element's fault, or kind none with `trouble()`.
  const Fault& fault() const { return e_->fault; }
  const char* trouble() const { return trouble_; }
  void note_trouble(const char* text) { trouble_ = text; }
  long factorizations() const { return factorizations_; }

 private:
  void set_pattern();
  bool factor();
  double factor_once();
  bool rows_are_independent();
  bool keep_independent_rows();
  /// Iterates x += A0^-1 (b - A x) at the present evaluation, b in (right_a_, right_c_), until x_a is right to
  /// rounding, of itself or of `scale`, and with `multipliers` x_c, too.
  bool refine(std::span<double> x_a, std::span<double> x_c, double scale, bool multipliers = false);
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

  const System& system_;
  int max_iterations_;
  KeptEvaluation e_;
  RowRank rows_;
  std::span<const double> h_;
  AccelerationMatrix matrix_;
  bool valid_ = false, has_pattern_ = false;  // its factors, its pattern
  double factored_time_ = 0.0;                // of its factors
  std::vector<double> factored_at_;           // their coordinates
  std::vector<double> unit_, per_unit_, update_, increment_, right_a_, right_c_, work_, size_;
  std::vector<double> multipliers_, first_multipliers_;
  std::vector<double> loads_;  // multipliers with those of driven bodies
  std::vector<SparseEntry> entries_;
  std::vector<char> dependent_;
  bool any_dependent_ = false, drifts_ = true;
  int rank_ = -1;  // of the rows that are kept; -1 before the first look
  int choice_of_rows_ = 0;
  long factorizations_ = 0;
  const Flows* flows_ = nullptr;
  double largest_pivot_ = 0.0, regularity_ = 1.0, last_regularity_ = 1.0;
  const char* trouble_ = "";
};

}  // namespace freeplay
