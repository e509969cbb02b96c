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
/// Rows that hold one body alone are eliminated with that body (see AnchoredBody); S is of the others, then.
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
  /// Starts with x = b and l = c; leaves the solution. `numbers` as they were factored.
  void solve(std::span<const double> numbers, std::span<double> x, std::span<double> l);

 private:
  /// S[target] += G_a W G_b^T: where the numbers of G_a and those of G_b W begin.
  struct Product {
    int target, a, b;
  };
  /// Those of bodies with `width` velocities; the others are none.
  template <int width, class Matrix>
  static auto& anchored(Matrix& of) {
    if constexpr (width == 3) {
      return of.anchored_in_plane_;
    } else {
      return of.anchored_in_space_;
    }
  }
  template <int width>
  bool set_pattern_in(std::span<const double> mass, int rows, std::span<const Piece> pieces);
  template <int width>
  std::vector<int> find_anchored(int rows, std::span<const Piece> pieces);
  template <int width>
  void multiply(std::span<const double> numbers);
  template <int width>
  void weigh(std::span<const double> numbers);
  template <int width>
  double eliminate_anchored(std::span<const double> numbers);
  template <int width>
  double factor_in(std::span<const double> numbers);
  template <int width>
  void substitute(std::span<const double> numbers, std::span<double> x, std::span<double> l);
  template <int width>
  void solve_others(std::span<const double> numbers, std::span<double> x, std::span<double> l);

  int width_ = 3;
  std::vector<AnchoredBody<3>> anchored_in_plane_;
  std::vector<AnchoredBody<6>> anchored_in_space_;
  std::vector<int> rows_;                  // all others, by their place in S
  std::vector<std::size_t> not_anchored_;  // bodies: where their numbers begin
  std::vector<double> inverse_mass_;
  struct Other {
    int row;              // its place in S
    int column, numbers;  // where the numbers of its body begin, and its own
  };
  std::vector<Other> pieces_;  // of rows that are not eliminated with a body
  std::vector<Product> products_;
  std::vector<double> weighted_;  // G W, as pieces_: W is M^-1, of anchored bodies their W'
  std::vector<int> others_;       // of pieces_, those of anchored bodies, one body after the other
  std::vector<double> shares_;    // as others_: S^-1 G W g^T of the body's own rows
  std::vector<double> diagonal_;  // of G M^-1 G^T
  ListedCholesky factors_;
  std::vector<double> multipliers_;
};

}  // namespace freeplay
