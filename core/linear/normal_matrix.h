// NormalMatrix: a saddle-point system with a diagonal mass matrix, solved by way of its multipliers.
#pragma once

#include <span>
#include <vector>

#include "linear/anchored_body.h"
#include "linear/listed_cholesky.h"

namespace freeplay {

/// [ M  G^T ] [ x ]   [ b ]
/// [ G   0  ] [ l ] = [ c ]   with M diagonal and positive, by  S = G M^-1 G^T,  S l = G M^-1 b - c,
///                            M x = b - G^T l  and S = L D L^T in an order that keeps L sparse
/// Rows that hold one body alone are blocks of S, which are factored by themselves.
/// G comes in pieces: `width` numbers of one row in the columns of one body. The condition of S is the square of that
/// of G: a solution wants to be refined where factor() returns little.
class NormalMatrix {
 public:
  struct Piece {
    int row, body;
  };

  /// `mass`: `width` numbers for each body, 3 or 6. No two pieces at one place. False where S or its factors would be
  /// much denser than G; it is of no use then. Allocates.
  bool set_pattern(std::span<const double> mass, int width, int rows, std::span<const Piece> pieces);
  /// Takes the numbers of the pieces, one after the other. Returns the smallest pivot of S in parts of its diagonal
  /// entry: 1 for rows that have nothing to do with each other, 0 where S is not positive definite to rounding.
  double factor(std::span<const double> numbers);
  /// Starts with x = b and l = -c; leaves the solution. `numbers` as they were factored.
  void solve(std::span<const double> numbers, std::span<double> x, std::span<double> l) const;

 private:
  /// S[target] += G_a M^-1 G_b^T, `a` of all pieces, `b` of pieces_
  struct Product {
    int target, a, b;
  };
  std::vector<int> find_anchored(int width, int rows, std::span<const Piece> pieces);
  template <int width>
  void multiply(std::span<const double> numbers);
  template <int width>
  double factor_anchored(std::span<const double> numbers);
  template <int width>
  void substitute(std::span<const double> numbers, std::span<double> x, std::span<double> l) const;

  int width_ = 3;
  std::vector<AnchoredBody> anchored_;
  std::vector<int> rows_;  // all others, by their place in S
  std::vector<double> inverse_mass_;
  struct Numbered {
    Piece where;  // `row` is a place in S
    int piece;    // among all
  };
  std::vector<Numbered> pieces_;
  std::vector<Product> products_;
  std::vector<double> weighted_;  // G M^-1, as pieces_
  std::vector<double> diagonal_;  // of S
  ListedCholesky factors_;
  mutable std::vector<double> multipliers_;
};

}  // namespace freeplay
