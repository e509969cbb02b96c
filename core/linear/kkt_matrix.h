// KktMatrix: a square sparse matrix with a fixed pattern, filled in place and factored again and again.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/archive.h"

namespace freeplay {

/// Place of one value in the matrix.
struct MatrixEntry {
  int row, column;
};

/// Up to 40 unknowns the inverse, with rows in parts of their largest entry. Above LU of the sparse matrix by KLU
/// (Davis and Palamadai Natarajan 2010, ACM TOMS 37, algorithm 907): block triangular form, so that unknowns that are
/// decided one after the other cost no more than a substitution; order and pivots found once and kept while they are
/// good.
class KktMatrix {
 public:
  static constexpr int largest_dense = 40;  ///< a product of this size costs about what KLU takes for ten unknowns
  KktMatrix();
  KktMatrix(KktMatrix&&) noexcept;
  KktMatrix& operator=(KktMatrix&&) noexcept;
  ~KktMatrix();

  /// Returns for every entry the index into values() where it lives; entries at one place share a slot. Values are
  /// zero and order and pivots forgotten.
  std::vector<int> set_pattern(int size, std::span<const MatrixEntry> entries);
  std::span<double> values();
  /// Factors values(); returns the smallest pivot over the largest, 0 for a singular matrix. Allocates only where the
  /// pivots are chosen anew: the first time, and where those of the last time have become bad.
  double factor();
  /// x with A x = b for the last factored A; `x` and `b` have size numbers and may not overlap.
  void solve(std::span<const double> b, std::span<double> x) const;

  /// The matrices from which factors and pivots follow. restore() expects the pattern, and makes both anew.
  void save(ArchiveWriter& archive) const;
  void restore(ArchiveReader& archive);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace freeplay
