// KktMatrix: a square matrix with a fixed pattern, filled in place and factored again and again.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace freeplay {

/// Place of one value in the matrix.
struct MatrixEntry {
  int row, column;
};

/// The pattern is given once; then values are added at the slots that set_pattern() returned, and factor() and solve()
/// follow. Nothing allocates after set_pattern().
class KktMatrix {
 public:
  virtual ~KktMatrix() = default;

  /// Returns for every entry the index into values() where it lives; entries at one place share a slot.
  virtual std::vector<int> set_pattern(int size, std::span<const MatrixEntry> entries) = 0;
  virtual std::span<double> values() = 0;
  /// Factors values(); returns the smallest pivot over the largest, 0 for a singular matrix.
  virtual double factor() = 0;
  /// x with A x = b for the last factored A; `x` and `b` have size numbers and may not overlap.
  virtual void solve(std::span<const double> b, std::span<double> x) const = 0;
};

/// LU with partial pivoting of a dense matrix.
std::unique_ptr<KktMatrix> make_dense_kkt();

}  // namespace freeplay
