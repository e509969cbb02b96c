// ConstraintJacobian: where the entries of Phi_q stand, and products with it.
//
// Phi_q is nc x nv: the derivative along tangent increments of q. A row of a joint has entries in the columns of its
// two bodies alone; these stand one after the other in ConstraintValues::jacobian, which functions here take as
// `entries`. Driven bodies have columns, too, of which the unknowns have none, and so have the rows that hold them.
#pragma once

#include <span>
#include <vector>

#include "linear/sparse_entry.h"
#include "system/layout.h"

namespace freeplay {

/// Rows of one element in the columns of one body: `rows` x body_velocities() numbers from `offset` on.
struct JacobianBlock {
  int row = 0, rows = 0, body = 0, offset = 0;
};

class ConstraintJacobian {
 public:
  explicit ConstraintJacobian(const Layout& layout) : layout_(layout) {}

  /// Makes room for rows of one element in the columns of the body at a place. Returns the offset of their entries, -1
  /// for ground.
  int add(BodyId place, int row, int rows);
  /// After the last one.
  void sort_rows();

  /// Of its rows and columns.
  const Layout& layout() const { return layout_; }
  /// How many entries there are.
  std::size_t size() const { return size_; }
  /// Of rows and bodies that are unknowns.
  std::span<const JacobianBlock> blocks() const { return blocks_; }
  /// What a row has in the columns of one body: from `offset` of the entries, for v from `velocity` on.
  struct RowPiece {
    int offset, velocity;
  };
  std::span<const RowPiece> row_pieces(std::size_t row) const {
    return std::span(pieces_).subspan(starts_[row], starts_[row + 1] - starts_[row]);
  }

  /// out += Phi_q^T lambda and out = Phi_q v.
  void add_transposed(std::span<const double> entries, std::span<const double> lambda, std::span<double> out) const;
  void multiply(std::span<const double> entries, std::span<const double> v, std::span<double> out) const;
  /// Phi_q by its entries; `out` only grows the first time.
  void list(std::span<const double> entries, std::vector<SparseEntry>& out) const;

  // Rows of unknowns in the columns of driven bodies, which have three numbers each:
  /// right -= Phi_q rate
  void move_with_driven(std::span<const double> entries, std::span<const double> rate, std::span<double> right) const;
  /// force -= Phi_q^T lambda
  void take_from_driven(std::span<const double> entries, std::span<const double> lambda, std::span<double> force) const;
  /// Power of the rows of joints on driven bodies at their velocities, with the opposite sign [W].
  double power_from_driven(std::span<const double> entries, std::span<const double> lambda,
                           std::span<const double> rate) const;

 private:
  /// A row of unknowns in the columns of a driven body, counted from the first of them.
  struct Coupling {
    int row, offset, body;
  };
  const Layout& layout_;
  std::size_t size_ = 0;
  std::vector<JacobianBlock> blocks_;
  std::vector<RowPiece> pieces_;     // row by row
  std::vector<std::size_t> starts_;  // in pieces_
  std::vector<Coupling> couplings_;
};

}  // namespace freeplay
