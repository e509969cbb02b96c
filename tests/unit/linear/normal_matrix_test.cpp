#include "linear/normal_matrix.h"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// A chain of bodies: row r holds bodies r and r + 1, the last row the last three. Before it, `alone` bodies that have
/// rows for themselves: 1, 2 ... as many as leave them a freedom, again 1 ..., in turn with each other.
struct Chain {
  Chain(int rows, int width, int alone = 0) : rows_(rows), bodies_(rows + 2 + alone), width_(width) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(0.5, 2.0);
    for (int c = 0; c < columns(); ++c) mass.push_back(number(random));
    const auto add = [&](int r, int body, double size) {
      pieces.push_back({r, body});
      for (int c = 0; c < width; ++c) numbers.push_back(size * number(random) * (c % 2 == 0 ? 1.0 : -1.0));
    };
    for (int r = 0; r + 1 < rows; ++r) {
      add(r, r, 1.0);
      add(r, r + 1, 0.3);  // else the condition grows with every row
    }
    for (int b = 1; b <= 3; ++b) add(rows - 1, bodies_ - b, 1.0);
    for (int turn = 1; turn < width; ++turn) {
      for (int b = 0; b < alone; ++b) {
        if (turn <= 1 + b % (width - 1)) add(rows_++, rows + 2 + b, 1.0);
      }
    }
    for (int i = 0; i < rows_ + columns(); ++i) right.push_back(number(random));
  }
  int columns() const { return bodies_ * width_; }
  /// By a dense LU of the whole system.
  Eigen::VectorXd solution() const {
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(rows_ + columns(), rows_ + columns());
    for (int c = 0; c < columns(); ++c) whole(c, c) = mass[static_cast<std::size_t>(c)];
    std::size_t next = 0;
    for (const auto& piece : pieces) {
      for (int c = width_ * piece.body; c < width_ * (piece.body + 1); ++c) {
        whole(columns() + piece.row, c) = whole(c, columns() + piece.row) = numbers[next++];
      }
    }
    return whole.fullPivLu().solve(Eigen::Map<const Eigen::VectorXd>(right.data(), rows_ + columns()));
  }
  int rows_, bodies_, width_;
  std::vector<double> mass, numbers, right;
  std::vector<NormalMatrix::Piece> pieces;
};

TEST(NormalMatrix, SolvesTheWholeSystem) {
  for (const int width : {3, 6}) {
    for (const auto& [rows, alone] : {std::pair(1, 0), {2, 0}, {7, 0}, {40, 0}, {1, 1}, {7, 5}, {2, 11}}) {
      const Chain chain(rows, width, alone);
      NormalMatrix matrix;
      ASSERT_TRUE(matrix.set_pattern(chain.mass, width, chain.rows_, chain.pieces));
      for (int again = 0; again < 2; ++again) {
        EXPECT_GT(matrix.factor(chain.numbers), 1e-3);
        const auto columns = static_cast<std::size_t>(chain.columns());
        std::vector<double> x(chain.right.begin(), chain.right.begin() + chain.columns()), l;
        for (std::size_t r = columns; r < chain.right.size(); ++r) l.push_back(-chain.right[r]);
        matrix.solve(chain.numbers, x, l);
        x.insert(x.end(), l.begin(), l.end());
        const Eigen::VectorXd expected = chain.solution();
        for (std::size_t i = 0; i < x.size(); ++i) {
          EXPECT_NEAR(x[i], expected[static_cast<Eigen::Index>(i)], 1e-12 * expected.norm())
              << rows << " " << alone << " " << i;
        }
      }
    }
  }
}

TEST(NormalMatrix, PivotFallsWithTheSquareOfTheDistanceFromASingularPosition) {
  // Two rows that become one: (1, 0, 0) and (1, d, 0).
  const double mass[] = {1.0, 2.0, 3.0};
  NormalMatrix matrix;
  const NormalMatrix::Piece pieces[] = {{0, 0}, {1, 0}};
  ASSERT_TRUE(matrix.set_pattern(mass, 3, 2, pieces));
  const auto pivot = [&](double d) {
    const double numbers[] = {1.0, 0.0, 0.0, 1.0, d, 0.0};
    return matrix.factor(numbers);
  };
  EXPECT_NEAR(pivot(1e-2) / pivot(1e-3), 100.0, 0.1);
  EXPECT_LT(pivot(0.0), 1e-15);
}

TEST(NormalMatrix, RefusesABodyThatMakesItDense) {
  std::vector<NormalMatrix::Piece> pieces;
  for (int r = 0; r < 100; ++r) pieces.push_back({r, 0});
  const double mass[] = {1.0, 1.0, 1.0};
  NormalMatrix matrix;
  EXPECT_FALSE(matrix.set_pattern(mass, 3, 100, pieces));
}

}  // namespace
}  // namespace freeplay
