#include "linear/normal_matrix.h"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// A chain of links: row r holds columns r and r + 1, the last row the last four.
struct Chain {
  explicit Chain(int rows) : rows_(rows), columns_(rows + 3) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(0.5, 2.0);
    for (int c = 0; c < columns_; ++c) mass.push_back(number(random));
    const auto add = [&](int r, int c) {
      entries.push_back({r, c, values.size()});
      values.push_back(number(random) * (c % 2 == 0 ? 1.0 : -1.0));
    };
    for (int r = 0; r + 1 < rows; ++r) {
      add(r, r);
      add(r, r + 1);
      values.back() *= 0.3;  // else the condition grows with every row
    }
    for (int c = 1; c <= 4; ++c) add(rows - 1, columns_ - c);
    for (int i = 0; i < rows + columns_; ++i) right.push_back(number(random));
  }
  /// By a dense LU of the whole system.
  Eigen::VectorXd solution() const {
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(rows_ + columns_, rows_ + columns_);
    for (int c = 0; c < columns_; ++c) whole(c, c) = mass[static_cast<std::size_t>(c)];
    for (const auto& e : entries) {
      whole(columns_ + e.row, e.column) = whole(e.column, columns_ + e.row) = values[e.value];
    }
    return whole.fullPivLu().solve(Eigen::Map<const Eigen::VectorXd>(right.data(), rows_ + columns_));
  }
  int rows_, columns_;
  std::vector<double> mass, values, right;
  std::vector<NormalMatrix::Entry> entries;
};

TEST(NormalMatrix, SolvesTheWholeSystem) {
  for (const int rows : {1, 2, 7, 40}) {
    const Chain chain(rows);
    NormalMatrix matrix;
    ASSERT_TRUE(matrix.set_pattern(chain.mass, rows, chain.entries));
    for (int again = 0; again < 2; ++again) {
      EXPECT_GT(matrix.factor(chain.values), 1e-3);
      std::vector<double> update(chain.right.size());
      matrix.solve(chain.right, update);
      const Eigen::VectorXd expected = chain.solution();
      for (std::size_t i = 0; i < update.size(); ++i) {
        EXPECT_NEAR(update[i], expected[static_cast<Eigen::Index>(i)], 1e-12 * expected.norm()) << rows << " " << i;
      }
    }
  }
}

TEST(NormalMatrix, PivotFallsWithTheSquareOfTheDistanceFromASingularPosition) {
  // Two rows that become one: (1, 0) and (1, d).
  const double mass[] = {1.0, 2.0};
  NormalMatrix matrix;
  ASSERT_TRUE(matrix.set_pattern(mass, 2, {{0, 0, 0}, {1, 0, 1}, {1, 1, 2}}));
  const auto pivot = [&](double d) {
    const double values[] = {1.0, 1.0, d};
    return matrix.factor(values);
  };
  EXPECT_NEAR(pivot(1e-2) / pivot(1e-3), 100.0, 0.1);
  EXPECT_LT(pivot(0.0), 1e-15);
}

TEST(NormalMatrix, RefusesABodyThatMakesItDense) {
  std::vector<NormalMatrix::Entry> entries;
  for (int r = 0; r < 100; ++r) entries.push_back({r, 0, static_cast<std::size_t>(r)});
  const double mass[] = {1.0};
  NormalMatrix matrix;
  EXPECT_FALSE(matrix.set_pattern(mass, 100, entries));
}

}  // namespace
}  // namespace freeplay
