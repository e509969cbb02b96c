// ListedCholesky: L D L^T of a sparse symmetric matrix of which every operation is listed once.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace freeplay {

/// For matrices that are factored a million times and are too small for the bookkeeping of a general method. The order
/// is the caller's.
class ListedCholesky {
 public:
  /// `entries`: (row, column) of the lower part; the diagonal is always there. False where the factors would take more
  /// than `most` operations, and nothing is set. Allocates.
  bool set_pattern(int size, const std::vector<std::pair<int, int>>& entries, std::size_t most);
  /// Index into values() of an entry of the pattern.
  int place(int row, int column) const;
  /// The lower part, to be filled in before each factor(), also where zeros fill in. The diagonal has the places
  /// diagonal(0), diagonal(1) ...
  std::span<double> values() { return values_; }
  int diagonal(int column) const { return starts_[static_cast<std::size_t>(column)]; }
  /// Takes values() for the factors. Afterwards their diagonal is D; pivots of zero go into the rest as infinities.
  void factor();
  /// x <- A^-1 x.
  void solve(std::span<double> x) const;

 private:
  std::vector<int> starts_;   // of each column in values_: its diagonal, then what is below
  std::vector<int> rows_;     // of each value
  std::vector<int> targets_;  // where the products of the entries below go, in the order of factor()
  std::vector<double> values_, inverse_;
};

}  // namespace freeplay
