#include "linear/listed_cholesky.h"

#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

using Entries = std::vector<std::pair<int, int>>;

/// An arrow that points to its first row, which fills in completely, or to its last, which does not.
Entries arrow(int size, int tip) {
  Entries entries;
  for (int i = 0; i < size; ++i) {
    if (i != tip) entries.emplace_back(std::max(i, tip), std::min(i, tip));
  }
  return entries;
}

void expect_solution(int size, const Entries& entries) {
  ListedCholesky cholesky;
  ASSERT_TRUE(cholesky.set_pattern(size, entries, 1000000));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int again = 0; again < 2; ++again) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
    std::ranges::fill(cholesky.values(), 0.0);
    const auto set = [&](int r, int c, double value) {
      a(r, c) = a(c, r) = value;
      cholesky.values()[static_cast<std::size_t>(cholesky.place(r, c))] = value;
    };
    for (int i = 0; i < size; ++i) set(i, i, size + number(random));
    for (const auto& [r, c] : entries) set(r, c, number(random));
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(size, [&] { return number(random); });
    Eigen::VectorXd x = b;
    cholesky.factor();
    cholesky.solve({x.data(), static_cast<std::size_t>(size)});
    EXPECT_LT((x - a.ldlt().solve(b)).norm(), 1e-14 * size) << size;
    const Eigen::VectorXd pivots = a.llt().matrixLLT().diagonal().cwiseAbs2();
    for (int i = 0; i < size; ++i) {
      EXPECT_NEAR(cholesky.values()[static_cast<std::size_t>(cholesky.diagonal(i))], pivots[i], 1e-13 * size);
    }
  }
}

TEST(ListedCholesky, SolvesWithAndWithoutFill) {
  expect_solution(1, {});
  expect_solution(6, arrow(6, 5));
  expect_solution(6, arrow(6, 0));
  expect_solution(5, {{1, 0}, {3, 1}, {4, 2}, {4, 0}});
}

TEST(ListedCholesky, EntriesMayBeNamedTwice) { expect_solution(3, {{2, 0}, {2, 0}, {1, 0}}); }

TEST(ListedCholesky, RefusesMoreOperationsThanAllowed) {
  ListedCholesky cholesky;
  EXPECT_TRUE(cholesky.set_pattern(100, arrow(100, 99), 1000));
  EXPECT_FALSE(cholesky.set_pattern(100, arrow(100, 0), 1000));
}

}  // namespace
}  // namespace freeplay
