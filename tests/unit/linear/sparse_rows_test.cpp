#include "linear/sparse_rows.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "linear/row_rank.h"
#include "linear/row_solutions.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double tolerance = 1e-10;

/// Rows that tie neighbours of a chain, three columns each, as joints tie bodies. `repeated` rows stand there twice.
SparseMatrix chain(int bodies, int repeated, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<SparseEntry> entries;
  const int rows = 2 * (bodies - 1);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < 6; ++c) entries.emplace_back(r, 3 * (r / 2) + c, uniform(engine));
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(repeated); ++i) {
    for (std::size_t c = 0; c < 6; ++c) {
      const SparseEntry& one = entries[6 * (3 * i) + c];
      entries.emplace_back(rows + static_cast<int>(i), one.col(), 2.0 * one.value());
    }
  }
  return sparse_matrix(rows + repeated, 3 * bodies, entries);
}

VectorXd random_vector(Eigen::Index size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return VectorXd::NullaryExpr(size, [&] { return uniform(engine); });
}

TEST(SparseRows, FindsTheRankAndAsManyDependentRows) {
  const SparseMatrix j = chain(30, 5, 1);
  const SparseRows rows(j, tolerance);
  EXPECT_EQ(rows.rank(), 58);
  EXPECT_EQ(std::ranges::count(rows.dependent(), char{1}), 5);
  MatrixXd kept(58, j.cols());
  const MatrixXd dense = j;
  int next = 0;
  for (int r = 0; r < j.rows(); ++r) {
    if (!rows.dependent()[static_cast<std::size_t>(r)]) kept.row(next++) = dense.row(r);
  }
  EXPECT_EQ(Eigen::FullPivLU<MatrixXd>(kept).rank(), 58);
}

TEST(NumericalRank, CountsNeitherEmptyNorDependentRows) {
  for (const int empty : {0, 1, 4}) {
    for (const int repeated : {0, 3}) {
      const SparseMatrix full = chain(6, repeated, 2);
      SparseMatrix j(full.rows() + empty, full.cols());
      std::vector<SparseEntry> entries;
      for (int c = 0; c < full.outerSize(); ++c) {
        for (SparseMatrix::InnerIterator one(full, c); one; ++one) {
          entries.emplace_back(static_cast<int>(one.row()) + empty / 2, c, one.value());
        }
      }
      j.setFromTriplets(entries.begin(), entries.end());
      EXPECT_EQ(numerical_rank(j), 10) << empty << " " << repeated;
    }
  }
}

TEST(SparseRows, SolutionsAreThoseOfLeastNorm) {
  const SparseMatrix j = chain(30, 5, 2);
  const VectorXd b = j * random_vector(j.cols(), 3);
  const VectorXd expected = MatrixXd(j).completeOrthogonalDecomposition().solve(b);
  EXPECT_LT((SparseRows(j, tolerance).least_norm_solution(b) - expected).norm(), 1e-11 * expected.norm());
}

TEST(SparseRows, MultipliersAreThoseOfTheDenseDecomposition) {
  const SparseMatrix j = chain(30, 5, 4);
  const int first_driver = 40;
  VectorXd lambda = random_vector(j.rows(), 5), expected = lambda;
  least_norm_multipliers(j, first_driver, tolerance, {lambda.data(), static_cast<std::size_t>(lambda.size())});
  std::vector<SparseEntry> entries;
  for (Eigen::Index c = 0; c < j.outerSize(); ++c) {
    for (SparseMatrix::InnerIterator it(j, c); it; ++it) entries.emplace_back(it.row(), it.col(), it.value());
  }
  RowRank dense(static_cast<int>(j.rows()), static_cast<int>(j.cols()));
  dense.analyse(entries);
  dense.express(entries, dense.dependent());
  dense.least_norm({expected.data(), static_cast<std::size_t>(expected.size())}, first_driver);
  EXPECT_GT((lambda - random_vector(j.rows(), 5)).norm(), 1e-3);
  EXPECT_LT((lambda - expected).norm(), 1e-7 * expected.norm());
}

TEST(RowSolutions, ManyRowsGiveWhatFewWould) {
  // Twice the size that is still dense, cut into independent parts that each are.
  const int bodies = 2 * static_cast<int>(most_dense_columns) / 3;
  const SparseMatrix j = chain(bodies, 7, 6);
  ASSERT_GT(j.cols(), most_dense_columns);
  EXPECT_EQ(numerical_rank(j), 2 * (bodies - 1));
  const VectorXd x = random_vector(j.cols(), 7), b = j * x;
  const VectorXd weight = random_vector(j.cols(), 8).cwiseAbs();
  const VectorXd least = least_norm_solution(j, b), weighted = least_weighted_solution(j, weight, b);
  EXPECT_LT((j * least - b).norm(), 1e-10 * b.norm());
  EXPECT_LT((j * weighted - b).norm(), 1e-10 * b.norm());
  // Of least norm and least weight: at right angles to every free motion, here the difference to another solution.
  EXPECT_LT(std::abs(least.dot(x - least)), 1e-9 * x.squaredNorm());
  EXPECT_LT(std::abs(weighted.dot(weight.cwiseProduct(x - weighted))), 1e-9 * x.squaredNorm());
}

TEST(RowSolutions, FindsAMotionThatMovesNoWeight) {
  const SparseMatrix j = sparse_matrix(1, 3, {{0, 0, 1.0}, {0, 1, 1.0}});
  const VectorXd held = VectorXd::Unit(3, 2) + VectorXd::Unit(3, 0);
  EXPECT_FALSE(weightless_motion(j, held));
  const auto motion = weightless_motion(j, VectorXd::Unit(3, 0));
  ASSERT_TRUE(motion);
  EXPECT_NEAR(std::abs((*motion)[2]), 1.0, 1e-12);
}

}  // namespace
}  // namespace freeplay
