#include "linear/normal_matrix.h"

#include <cmath>
#include <random>
#include <tuple>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// A chain of bodies: row r holds bodies r and r + 1, the last row the last three. Behind them come rows that hold one
/// body alone, 1, 2 ... as many as leave it a freedom, again 1 ..., in turn with each other: those of every other body
/// of the chain where it is `anchored`, and of `alone` more bodies.
struct Chain {
  Chain(int rows, int width, int alone = 0, bool anchored = false)
      : rows_(rows), bodies_(rows + 2 + alone), width_(width) {
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
      const auto hold = [&](int body) {
        if (turn <= 1 + body % (width - 1)) add(rows_++, body, 1.0);
      };
      for (int b = 0; anchored && b < rows + 2; b += 2) hold(b);
      for (int b = rows + 2; b < bodies_; ++b) hold(b);
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
    using Case = std::tuple<int, int, bool>;
    for (const auto& [rows, alone, anchored] : {Case(1, 0, false),
                                                {2, 0, false},
                                                {7, 0, false},
                                                {40, 0, false},
                                                {1, 1, false},
                                                {7, 5, false},
                                                {2, 11, false},
                                                {2, 0, true},
                                                {11, 0, true},
                                                {40, 3, true}}) {
      const Chain chain(rows, width, alone, anchored);
      NormalMatrix matrix;
      ASSERT_TRUE(matrix.set_pattern(chain.mass, width, chain.rows_, chain.pieces));
      for (int again = 0; again < 2; ++again) {
        EXPECT_GT(matrix.factor(chain.numbers), 1e-3);
        const auto columns = static_cast<std::size_t>(chain.columns());
        std::vector<double> x(chain.right.begin(), chain.right.begin() + chain.columns()), l;
        for (std::size_t r = columns; r < chain.right.size(); ++r) l.push_back(chain.right[r]);
        matrix.solve(chain.numbers, x, l);
        x.insert(x.end(), l.begin(), l.end());
        const Eigen::VectorXd expected = chain.solution();
        for (std::size_t i = 0; i < x.size(); ++i) {
          EXPECT_NEAR(x[i], expected[static_cast<Eigen::Index>(i)], 1e-12 * expected.norm())
              << rows << " " << alone << " " << anchored << " " << i;
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

TEST(NormalMatrix, WhatIsNoNumberIsNotRegular) {
  // One body with a row of its own, two with a row between them, two more with another.
  const std::vector<double> mass(15, 1.0);
  NormalMatrix matrix;
  const NormalMatrix::Piece pieces[] = {{0, 0}, {1, 1}, {1, 2}, {2, 3}, {2, 4}};
  ASSERT_TRUE(matrix.set_pattern(mass, 3, 3, pieces));
  std::vector<double> numbers(15, 1.0);
  EXPECT_EQ(matrix.factor(numbers), 1.0);
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    std::vector<double> wrong = numbers;
    wrong[i] = std::nan("");
    EXPECT_EQ(matrix.factor(wrong), 0.0) << i;
  }
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
