// StageMatrix: the matrix of a stage's equations at one pair of betas, and its factors.
//
//   [ K      Phi_q^T ]      K = M - beta_v f_v - beta_q f_q
//   [ Phi_q  0       ]
//
// Prescribed bodies p are taken out of the unknowns: their rows give da_p at once, what is left is solved without them,
// and their motion equations then give the multipliers of their rows, with them the loads of the drivers. Unknowns that
// are then alone in their row and column, as those of a body that only forces move, are divided out.
#pragma once

#include <span>
#include <vector>

#include "base/archive.h"
#include "linear/kkt_matrix.h"
#include "stage/internal_elimination.h"
#include "stage/prescribed_bodies.h"
#include "system/system.h"

namespace freeplay {

class StageMatrix {
 public:
  /// Without `forces`, for betas of zero only: the index-1 matrix.
  StageMatrix(const System& system, bool forces)
      : system_(system), forces_(forces), internal_(system.layout(), system.forces()) {}

  /// Leaves out the rows that are marked in `dependent`, whose multipliers then stay as they are. Allocates, and
  /// forgets the factors.
  void set_pattern(std::span<const char> dependent);
  /// Fills in the derivatives at `e` (Phi_q, with forces term_derivative) and factors. Returns the smallest pivot over
  /// the largest.
  double factor(Evaluation& e, double beta_q, double beta_v, double beta_z);
  /// The update (da, dlambda) for a right side, which is used up.
  void solve(std::span<double> right, std::span<double> update);
  InternalElimination& internal() { return internal_; }

  /// The matrix from which the factors follow. restore() expects the pattern.
  void save(ArchiveWriter& archive) const { archive(values_, internal_, rest_); }
  void restore(ArchiveReader& archive);

 private:
  /// An entry outside of the matrix that is factored: `right[row] -= value * update[column]`.
  struct Coupling {
    int row, column;
  };
  /// Ranges of couplings_ that are used with it, and Phi_q of its rows in its own columns.
  struct Prescribed {
    PrescribedBody who;
    std::size_t first_row_part = 0, end_row_part = 0;        // its rows in the columns of bodies before it
    std::size_t first_motion_part = 0, end_motion_part = 0;  // its motion equations without its own multipliers
    double inverse[36];                                      // by columns; in the plane 3 x 3
  };
  /// The slots of all entries, in the order in which factor() fills them.
  struct Slots {
    std::vector<int> constant;  // masses, and ones of dependent rows
    std::vector<int> forces;    // of each pair of bodies, 6 x 6 or 12 x 12
    std::vector<int> turning;   // in space, with forces: 3 x 3 by body
    std::vector<int> rows;      // Phi_q, each entry followed by that of the transposed
  };
  template <int width>
  double invert_blocks();
  template <int width>
  void substitute(std::span<double> right, std::span<double> update);
  /// Where the unknowns are solved for, by their place in the whole system.
  struct Division {
    std::vector<int> owner;     // prescribed body of a coordinate or row; -1: a free one
    std::vector<int> place;     // of a free one, in alone_ or unknowns_
    std::vector<char> coupled;  // shares a row or column with another free one

    bool is_free(int i) const { return owner[static_cast<std::size_t>(i)] < 0; }
    /// Phi_q of a prescribed body's rows in its own columns, or transposed.
    bool is_block(int row, int column, int nv) const {
      return row >= 0 && !is_free(row) &&
             owner[static_cast<std::size_t>(row)] == owner[static_cast<std::size_t>(column)] &&
             (row < nv) != (column < nv);
    }
  };
  std::vector<MatrixEntry> entries(std::span<const char> dependent) const;
  void add_force_entries(std::vector<MatrixEntry>& all) const;
  /// Finds prescribed_, alone_ and unknowns_.
  Division divide(std::span<const MatrixEntry> all, std::span<const char> dependent);
  /// The slots of entries in values_: of blocks, then of couplings, then of free unknowns.
  void place_blocks(std::span<const MatrixEntry> all, const Division& division, std::span<int> slots) const;
  void place_couplings(std::span<const MatrixEntry> all, const Division& division, std::span<int> slots);
  void place_free(std::span<const MatrixEntry> all, const Division& division, std::span<int> slots);
  void share_out(const std::vector<int>& slots);
  void fill_forces(Evaluation& e, double beta_q, double beta_v, double beta_z);
  void subtract(std::size_t first, std::size_t end, std::span<const double> update, std::span<double> right) const;

  const System& system_;
  bool forces_;
  InternalElimination internal_;
  KktMatrix rest_;
  std::vector<Prescribed> prescribed_;
  std::vector<Coupling> couplings_;
  std::size_t first_free_part_ = 0;  // couplings of what is factored with prescribed bodies stand from here to the end
  std::vector<int> alone_;           // places of unknowns that are divided out
  std::vector<int> unknowns_;        // places of the unknowns of rest_ in the whole system
  Slots slots_;
  // A number for what is left out, Phi_q of each prescribed body by columns, then couplings_, alone_, rest_.
  std::vector<double> values_;
  std::size_t first_coupling_ = 0, first_alone_ = 0, first_rest_ = 0;
  std::vector<double> rest_right_, rest_update_;
};

}  // namespace freeplay
