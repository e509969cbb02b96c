// AccelerationMatrix: the matrix of the index-1 equations, and its factors.
//
//   [ M      Phi_q^T ] [ a      ]   [ f     ]
//   [ Phi_q  0       ] [ lambda ] = [ gamma ]
//
// Prescribed bodies are taken out of the unknowns: their rows give their accelerations at once, and their motion
// equations give the multipliers of these rows, with them the loads of the drivers. M is diagonal, so that what is left
// is a matter of the multipliers alone. Where these depend on each other so much that digits would be lost, and of
// bodies without mass, the whole matrix is factored.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/archive.h"
#include "linear/normal_matrix.h"
#include "stage/matrix.h"
#include "stage/prescribed_bodies.h"
#include "system/system.h"

namespace freeplay {

class AccelerationMatrix {
 public:
  explicit AccelerationMatrix(const System& system) : system_(system) {}

  /// Leaves out the rows that are marked in `dependent`, whose multipliers then stay as they are. Allocates, and
  /// forgets the factors.
  void set_pattern(std::span<const char> dependent);
  /// Factors at `e`, which holds Phi_q. Returns the smallest pivot over the largest.
  double factor(Evaluation& e);
  /// Takes x = f and l = gamma for the solution a and lambda.
  void solve(std::span<double> x, std::span<double> l);
  /// After factor(): a solution satisfies all equations as well as its forces and accelerations are rounded.
  bool is_well_conditioned() const { return by_normal_ && smallest_ > well_conditioned; }
  /// After factor(): true if the rows are far from depending on each other. False: it is not known.
  bool has_independent_rows() const { return by_normal_; }

  /// Phi_q from which the factors follow. restore() expects the pattern.
  void save(ArchiveWriter& archive) const;
  void restore(ArchiveReader& archive);

 private:
  /// A piece that couples a row with a prescribed body, other than its own rows.
  struct Coupling {
    int row, body;
    std::size_t piece;
  };
  struct Prescribed {
    PrescribedBody who;
    std::array<std::size_t, 6> pieces{};                     // Phi_q of its rows in its own columns
    std::size_t first_row_part = 0, end_row_part = 0;        // of by_row_: its rows
    std::size_t first_motion_part = 0, end_motion_part = 0;  // of by_body_: its columns
    double inverse[36];                                      // by columns; in the plane 3 x 3
  };
  /// Prescribed bodies by row and by body; -1: none.
  struct Owners {
    std::vector<int> of_row, of_body;
  };
  /// What a row has in the columns of one body, in ConstraintValues::jacobian.
  struct Source {
    bool held;  // by a prescribed body
    int row, body, offset;
    bool same_piece(const Source& other) const { return row == other.row && body == other.body; }
  };
  /// Finds prescribed_ and free_rows_.
  Owners find_prescribed();
  /// Finds numbers_ and what they are used for. Returns the pieces of free rows and bodies.
  std::vector<NormalMatrix::Piece> place_pieces(const Owners& owners);
  std::vector<Source> sorted_sources(const Owners& owners) const;
  void sort_couplings(const Owners& owners);
  void make_whole();
  double factor_whole(Evaluation& e, double normal);
  template <int width>
  void gather(std::span<const double> jacobian);
  template <int width>
  double invert_blocks();
  template <int width>
  void substitute(std::span<double> x, std::span<double> l);
  void solve_whole(std::span<double> x, std::span<double> l);

  const System& system_;
  std::vector<char> dependent_;
  /// Phi_q in pieces, numbers of one row in the columns of one body, first those of free rows and bodies; where they
  /// stand in ConstraintValues::jacobian, and further numbers that are added to some.
  std::vector<double> numbers_;
  std::vector<int> offsets_;
  struct Addition {
    std::size_t piece;
    int offset;
  };
  std::vector<Addition> additions_;
  std::vector<Prescribed> prescribed_;
  std::vector<Coupling> by_row_, by_body_;  // by the prescribed body of the row, free ones last; and of the column
  std::size_t first_free_part_ = 0;         // of by_row_
  std::vector<int> free_rows_;
  NormalMatrix normal_;
  bool has_normal_ = false, by_normal_ = false;
  bool all_free_ = false;  ///< no row is one of prescribed bodies or left out
  double smallest_ = 0.0;  // pivot of the normal matrix and of the blocks that prescribe bodies
  static constexpr double well_conditioned = 1e-2;
  std::unique_ptr<StageMatrix> whole_;
  double unit_ = 0.0;                // pivot of whole_ over that of normal_, where both were factored last; 0: not yet
  std::vector<double> multipliers_;  // of free rows
  std::vector<double> forces_;       // on prescribed bodies
  std::vector<double> right_, update_;
};

}  // namespace freeplay
