#include "linear/row_rank.h"

#include <algorithm>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<SparseEntry> entries(const RowMajor& m) {
  std::vector<SparseEntry> all;
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    for (Eigen::Index c = 0; c < m.cols(); ++c) all.emplace_back(r, c, m(r, c));
  }
  return all;
}

RowMajor random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  RowMajor m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = uniform(engine);
  return m;
}
/// Product of random factors: rank `rank`.
RowMajor of_rank(int rank, int rows, int columns, unsigned seed) {
  return random_matrix(rows, rank, seed) * random_matrix(rank, columns, seed + 1);
}
long dependent(const RowRank& rank) { return std::ranges::count(rank.dependent(), char{1}); }

TEST(RowRank, IndependentRowsAreAllKept) {
  RowRank rank(4, 7);
  EXPECT_EQ(rank.analyse(entries(random_matrix(4, 7, 1))), 4);
  EXPECT_EQ(rank.rank(), 4);
  EXPECT_EQ(dependent(rank), 0);
}

TEST(RowRank, OneOfTwoEqualRowsIsDependent) {
  RowMajor j = random_matrix(4, 6, 2);
  j.row(3) = j.row(1);
  RowRank rank(4, 6);
  EXPECT_EQ(rank.analyse(entries(j)), 3);
  EXPECT_EQ(dependent(rank), 1);
  EXPECT_EQ(rank.dependent()[1] + rank.dependent()[3], 1);
}

TEST(RowRank, KeptRowsSpanTheOthers) {
  const RowMajor j = of_rank(3, 7, 9, 3);
  RowRank rank(7, 9);
  ASSERT_EQ(rank.analyse(entries(j)), 3);
  EXPECT_EQ(dependent(rank), 4);
  RowMajor kept(3, 9);
  int next = 0;
  for (int r = 0; r < 7; ++r) {
    if (!rank.dependent()[static_cast<std::size_t>(r)]) kept.row(next++) = j.row(r);
  }
  EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXd>(kept).rank(), 3);
}

TEST(RowRank, MoreRowsThanColumnsAndZeroRows) {
  RowRank many(6, 3), none(0, 3), zero(2, 3);
  EXPECT_EQ(many.analyse(entries(random_matrix(6, 3, 4))), 3);
  EXPECT_EQ(dependent(many), 3);
  EXPECT_EQ(none.analyse({}), 0);
  EXPECT_EQ(zero.analyse(entries(RowMajor::Zero(2, 3))), 0);
  EXPECT_EQ(dependent(zero), 2);
}

// The threshold is 1e-10 of the largest pivot.
TEST(RowRank, ToleranceIsRelativeToTheLargestPivot) {
  for (const double scale : {1.0, 1e-6, 1e6}) {
    RowMajor j(2, 3);
    j << 1.0, 0.0, 0.0, 1.0, 1e-12, 0.0;
    RowRank rank(2, 3);
    EXPECT_EQ(rank.analyse(entries(RowMajor(scale * j))), 1);
    j(1, 1) = 1e-8;
    EXPECT_EQ(rank.analyse(entries(RowMajor(scale * j))), 2);
  }
}

TEST(RowRank, CanBeUsedAgainAfterTheRankHasChanged) {
  RowRank rank(3, 4);
  EXPECT_EQ(rank.analyse(entries(of_rank(2, 3, 4, 5))), 2);
  EXPECT_EQ(rank.analyse(entries(random_matrix(3, 4, 6))), 3);
  EXPECT_EQ(dependent(rank), 0);
  EXPECT_EQ(rank.analyse(entries(of_rank(1, 3, 4, 7))), 1);
  EXPECT_EQ(dependent(rank), 2);
}

/// Least-norm multipliers, judged by the conditions of a minimum on a null space that another decomposition gives.
void expect_least_norm(const RowMajor& j, int first_driver, unsigned seed) {
  const int rows = static_cast<int>(j.rows());
  RowRank rank(rows, static_cast<int>(j.cols()));
  rank.analyse(entries(j));
  rank.express(entries(j), rank.dependent());
  const Eigen::VectorXd before = random_matrix(rows, 1, seed);
  Eigen::VectorXd after = before;
  rank.least_norm({after.data(), static_cast<std::size_t>(rows)}, first_driver);
  // What the bodies feel is the same.
  EXPECT_LT((j.transpose() * (after - before)).norm(), 1e-12 * j.norm());

  const Eigen::MatrixXd null = Eigen::FullPivLU<Eigen::MatrixXd>(j.transpose()).kernel();
  ASSERT_EQ(null.cols(), rows - rank.rank());
  const int drivers = rows - first_driver;
  const Eigen::MatrixXd null_drivers = null.bottomRows(drivers);
  EXPECT_LT((null_drivers.transpose() * after.tail(drivers)).norm(), 1e-11) << "driver efforts";
  // Directions that leave the drivers alone.
  Eigen::FullPivLU<Eigen::MatrixXd> free(null_drivers);
  free.setThreshold(1e-9);
  if (free.dimensionOfKernel() == 0) return;
  const Eigen::MatrixXd joints = (null * free.kernel()).topRows(first_driver);
  EXPECT_LT((joints.transpose() * after.head(first_driver)).norm(), 1e-11) << "joint reactions";
}

TEST(LeastNorm, DriversComeBeforeJoints) {
  expect_least_norm(of_rank(4, 7, 6, 10), 5, 11);  // three free directions, two drivers
  expect_least_norm(of_rank(6, 7, 6, 12), 3, 13);  // one free direction, four drivers
  expect_least_norm(of_rank(3, 8, 9, 14), 4, 15);  // five free directions, four drivers
}

TEST(LeastNorm, WithoutDriversJointsAloneAreLeast) {
  const RowMajor j = of_rank(2, 4, 3, 16);
  RowRank rank(4, 3);
  rank.analyse(entries(j));
  rank.express(entries(j), rank.dependent());
  Eigen::VectorXd lambda = random_matrix(4, 1, 17);
  const Eigen::VectorXd want =
      Eigen::MatrixXd(j.transpose()).completeOrthogonalDecomposition().solve(Eigen::VectorXd(j.transpose() * lambda));
  rank.least_norm({lambda.data(), 4}, 4);
  EXPECT_LT((lambda - want).norm(), 1e-12);
}

TEST(LeastNorm, FullRankIsLeftAlone) {
  RowRank rank(3, 5);
  rank.analyse(entries(random_matrix(3, 5, 18)));
  rank.express(entries(random_matrix(3, 5, 18)), rank.dependent());
  std::vector<double> lambda{1.0, -2.0, 3.0};
  rank.least_norm(lambda, 2);
  EXPECT_EQ(lambda, (std::vector<double>{1.0, -2.0, 3.0}));
}

// In a stage that is off the constraints by s no row depends exactly on others any more: multipliers go on smoothly
// from those on the constraints, and their resultant with them.
TEST(LeastNorm, GoesOnSmoothlyOffTheConstraints) {
  constexpr int rows = 7, columns = 9, first_driver = 5;
  RowMajor on = random_matrix(rows, columns, 20);
  on.row(3) = 2.0 * on.row(0) - on.row(1);  // joints alone, so that drivers have no part in it
  const RowMajor off = random_matrix(rows, columns, 21);
  const Eigen::VectorXd before = random_matrix(rows, 1, 22);
  RowRank rank(rows, columns);
  ASSERT_EQ(rank.analyse(entries(on)), 6);
  const std::vector<char> left_out(rank.dependent().begin(), rank.dependent().end());
  const auto least = [&](double s) {
    Eigen::VectorXd lambda = before;
    rank.express(entries(RowMajor(on + s * off)), left_out, 10.0 * s);
    rank.least_norm({lambda.data(), rows}, first_driver);
    return lambda;
  };
  const Eigen::VectorXd here = least(0.0);
  for (const double s : {1e-2, 1e-4, 1e-6}) {
    const Eigen::VectorXd near = least(0.5 * s), far = least(s);
    EXPECT_LT((far - here).norm(), 20.0 * s);
    EXPECT_LT((far - 2.0 * near + here).norm(), 100.0 * s * s + 1e-14);
    EXPECT_LT((on.transpose() * (far - before)).norm(), 20.0 * s);
  }
}

TEST(RowRank, SaysWhichOtherChoiceOfRowsIsMoreIndependent) {
  RowMajor j(3, 2);
  j << 1.0, 0.0, 1.0, 0.01, 0.0, 1.0;
  RowRank rank(3, 2);
  const LeftOutRows narrow = rank.express(entries(j), std::vector<char>{0, 0, 1});
  EXPECT_NEAR(narrow.largest, 100.0, 1e-10);  // [0 1] = 100 ([1 0.01] - [1 0])
  EXPECT_EQ(narrow.left_out, 2);
  EXPECT_LT(narrow.rest, 1e-12);
  EXPECT_NEAR(rank.express(entries(j), std::vector<char>{0, 1, 0}).largest, 1.0, 1e-12);
  EXPECT_NEAR(rank.express(entries(j), std::vector<char>{0, 1, 1}).rest, 1.0, 1e-12);
}

}  // namespace
}  // namespace freeplay
