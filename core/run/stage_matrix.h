// StageMatrix: the matrix of a stage's equations at one pair of betas, and its factors.
//
//   [ M - beta_v f_v - beta_q f_q   Phi_q^T ]
//   [ Phi_q                         0       ]
#pragma once

#include <span>
#include <vector>

#include "linear/kkt_matrix.h"
#include "run/internal_elimination.h"
#include "system/system.h"

namespace freeplay {

class StageMatrix {
 public:
  /// Without `forces` for betas of zero alone: the index-1 matrix.
  StageMatrix(const System& system, bool forces) : system_(system), forces_(forces), internal_(system) {}

  /// Leaves out the rows that are marked in `dependent`, whose multipliers then stay as they are. Allocates, and
  /// forgets the factors.
  void set_pattern(std::span<const char> dependent);
  /// Fills in the derivatives at `e` (Phi_q, with forces term_derivative) and factors. Returns the smallest pivot over
  /// the largest.
  double factor(Evaluation& e, double beta_q, double beta_v, double beta_z);
  void solve(std::span<const double> right, std::span<double> update) const { matrix_.solve(right, update); }
  InternalElimination& internal() { return internal_; }

 private:
  void add_forces(const Evaluation& e, double beta_q, double beta_v, const int*& slot, std::span<double> values) const;

  const System& system_;
  bool forces_;
  KktMatrix matrix_;
  InternalElimination internal_;
  std::vector<int> slots_;  // -1: left out
};

}  // namespace freeplay
