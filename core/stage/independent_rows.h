// IndependentRows: which constraint equations the others determine, and how far those that are left are from depending
// on each other.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "linear/row_rank.h"
#include "system/constraints.h"

namespace freeplay {

/// Redundant equations are left out of the matrices, and checked to hold by themselves. The choice is made at the
/// first factorization, and again where a pivot vanishes, as the rank may change along the motion.
class IndependentRows {
 public:
  static constexpr double singular_pivot = 1e-13;  ///< smallest pivot over the largest

  explicit IndependentRows(const ConstraintJacobian& jacobian);

  /// Nonzero for equations that the others determine.
  std::span<const char> dependent() const { return dependent_; }
  bool any_dependent() const { return any_dependent_; }
  /// Grows whenever others than before are left out: factors and patterns made before are of no use then.
  int choice() const { return choice_; }
  /// Whether a choice has been made.
  bool is_known() const { return rank_ >= 0; }
  void keep_all() { rank_ = jacobian_.layout().nc(); }
  /// Of the rows that are kept; -1 before a choice has been made.
  int rank() const { return rank_; }
  /// Whether the equations hold all velocities: everything moves as drivers do, whatever loads do.
  bool hold_everything() const { return rank_ >= jacobian_.layout().nv() || jacobian_.layout().nv() == 0; }
  /// Makes the choice anew from Phi_q of `e`. Returns whether it is another one than before.
  bool find(const ConstraintValues& e);
  /// The same, but only a rank that is larger than before counts, and on the constraints another choice of as many
  /// rows that is far more independent: what is kept may come to depend on each other as the mechanism moves on.
  /// `error`: see RowRank::analyse().
  void find_more(const ConstraintValues& e, double error);
  /// Multipliers of least norm for the same forces on the bodies: efforts of drivers first, then reactions. Phi_q is
  /// that of the last find_more().
  void least_norm(std::span<double> lambda);
  /// Row that comes closest to depending on the others, or -1. Slow.
  int weakest(const ConstraintValues& e);

  void begin_attempt() { regularity_ = 1.0; }
  /// The smallest pivot of the index-1 matrix at another position.
  void note_pivot(double pivot) {
    largest_pivot_ = std::max(largest_pivot_, pivot);
    last_regularity_ = pivot / largest_pivot_;
    regularity_ = std::min(regularity_, last_regularity_);
  }
  /// Smallest pivot in the present attempt, or in the last that had one, in parts of its largest value in the run. It
  /// falls with the square of the distance from a singular position of the constraints.
  double regularity() const { return regularity_ < 1.0 ? regularity_ : last_regularity_; }
  /// The same in the present attempt alone: 1 where it had no pivot.
  double attempt_regularity() const { return regularity_; }

  /// Both regularities, so that an evaluation elsewhere can restore them; `last`: at the most recent factorization.
  struct Regularity {
    double attempt = 1.0, last = 1.0;
  };
  Regularity regularities() const { return {regularity_, last_regularity_}; }
  void put_back(const Regularity& then) { regularity_ = then.attempt, last_regularity_ = then.last; }

  /// Multipliers of least norm are only asked for where find_more() was called before.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.dependent_, self.any_dependent_, self.rank_, self.choice_);
    archive(self.largest_pivot_, self.regularity_, self.last_regularity_);
  }

 private:
  bool adopt();
  LeftOutRows express();
  void exchange_rows(LeftOutRows now);

  const ConstraintJacobian& jacobian_;
  RowRank rank_of_;
  std::vector<SparseEntry> entries_;
  std::vector<char> dependent_;
  bool any_dependent_ = false;
  int rank_ = -1;  // of the rows that are kept; -1 before the first choice
  int choice_ = 0;
  int expressed_choice_ = -1;  // by which rank_of_ expresses what is left out
  double error_ = 0.0;         // of the last find_more()
  double largest_pivot_ = 0.0, regularity_ = 1.0, last_regularity_ = 1.0;
};

}  // namespace freeplay
