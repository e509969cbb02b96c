// NormalMatrix: a saddle-point system with a diagonal mass matrix, solved by way of its multipliers.
#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCholesky>

namespace freeplay {

/// [ M  G^T ] [ x ]   [ b ]
/// [ G   0  ] [ l ] = [ c ]   with M diagonal and positive, by  S = G M^-1 G^T,  S l = G M^-1 b - c,
///                            M x = b - G^T l  and S = L D L^T in an order that keeps L sparse
/// The condition of S is the square of that of G: a solution wants to be refined where factor() returns little.
class NormalMatrix {
 public:
  /// One value of G and where it stands in the `values` of factor().
  struct Entry {
    int row, column;
    std::size_t value;
  };

  /// No two entries at one place. False where S would be much denser than G, and nothing is set. Allocates.
  bool set_pattern(std::span<const double> mass, int rows, std::vector<Entry> entries);
  /// Returns the smallest pivot of S in parts of its diagonal entry: 1 for rows that have nothing to do with each
  /// other, 0 where S is not positive definite to rounding.
  double factor(std::span<const double> values);
  /// `right` and `update`: x or b first, then l or c.
  void solve(std::span<const double> right, std::span<double> update) const;

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  /// The decomposition without the copies that it makes of a matrix and of its pivots.
  struct Factors : Eigen::SimplicialLDLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>> {
    void refactor(const Sparse& s) { factorize_preordered<true>(s); }
    const VectorType& pivots() const { return m_diag; }
  };
  /// S[target] += G_a (G M^-1)_b
  struct Product {
    int target, a, b;
  };
  std::vector<int> order_;  // of a row: its place in S
  std::vector<double> inverse_mass_;
  std::vector<Entry> entries_;  // by column; `row` is a place in S
  std::vector<Product> products_;
  std::vector<double> numbers_, weighted_;  // G, and G M^-1, by entry
  std::vector<int> diagonal_;               // of S: places among its values
  Sparse s_;                                // upper part
  Factors factors_;
  mutable Eigen::VectorXd multipliers_;
};

}  // namespace freeplay
