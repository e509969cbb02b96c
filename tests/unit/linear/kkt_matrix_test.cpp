#include "linear/kkt_matrix.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(KktMatrix, SolvesWhatItsSlotsHold) {
  KktMatrix matrix;
  // [4 1 0; 1 0 2; 0 3 0] with a pivot of zero on the diagonal.
  const std::vector<MatrixEntry> entries{{0, 0}, {0, 1}, {1, 0}, {1, 2}, {2, 1}};
  const std::vector<int> slots = matrix.set_pattern(3, entries);
  const double values[] = {4.0, 1.0, 1.0, 2.0, 3.0};
  for (std::size_t i = 0; i < 5; ++i) matrix.values()[static_cast<std::size_t>(slots[i])] = values[i];
  EXPECT_GT(matrix.factor(), 0.1);
  const double b[] = {6.0, 7.0, 6.0};
  double x[3];
  matrix.solve(b, x);
  EXPECT_DOUBLE_EQ(x[0], 1.0);
  EXPECT_DOUBLE_EQ(x[1], 2.0);
  EXPECT_DOUBLE_EQ(x[2], 3.0);
}

TEST(KktMatrix, EntriesAtOnePlaceShareASlot) {
  KktMatrix matrix;
  const std::vector<MatrixEntry> entries{{0, 0}, {1, 1}, {0, 0}};
  const std::vector<int> slots = matrix.set_pattern(2, entries);
  EXPECT_EQ(slots[0], slots[2]);
  EXPECT_NE(slots[0], slots[1]);
}

TEST(KktMatrix, ASingularMatrixHasNoPivot) {
  KktMatrix matrix;
  const std::vector<MatrixEntry> entries{{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  const std::vector<int> slots = matrix.set_pattern(2, entries);
  const double values[] = {1.0, 2.0, 2.0, 4.0};
  for (std::size_t i = 0; i < 4; ++i) matrix.values()[static_cast<std::size_t>(slots[i])] = values[i];
  EXPECT_LT(matrix.factor(), 1e-15);
}

/// Saddle-point matrices [M G^T; G 0] with rows of very different size, zeros on the diagonal and few entries beside
/// it, against a dense LU with full pivoting of Eigen. Small ones are inverted, larger ones factored by KLU.
TEST(KktMatrix, SolvesSaddlePointsOfEverySize) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int size = 1; size <= KktMatrix::largest_dense + 4; ++size) {
    const int rows = size / 3, bodies = size - rows;
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < bodies; ++i) full(i, i) = std::pow(10.0, 3.0 * number(random));
    for (int i = 0; i + 1 < bodies; i += 2) full(i, i + 1) = 0.3 * full(i, i) * number(random);
    for (int r = bodies; r < size; ++r) {
      for (const int c : {r - bodies, 2 * (r - bodies), bodies - 1})
        full(r, c) = full(c, r) = 0.5 + std::abs(number(random));
    }
    std::vector<MatrixEntry> entries;
    for (int r = 0; r < size; ++r) {
      for (int c = 0; c < size; ++c) {
        if (full(r, c) != 0.0) entries.push_back({r, c});
      }
    }
    KktMatrix matrix;
    const std::vector<int> slots = matrix.set_pattern(size, entries);
    for (int pass = 0; pass < 2; ++pass) {  // the second time with other numbers
      full *= 1.0 + pass;
      for (std::size_t i = 0; i < entries.size(); ++i) {
        matrix.values()[static_cast<std::size_t>(slots[i])] = full(entries[i].row, entries[i].column);
      }
      ASSERT_GT(matrix.factor(), 0.0) << size;
      const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(size, [&] { return number(random); });
      const Eigen::VectorXd expected = full.fullPivLu().solve(b);
      std::vector<double> x(static_cast<std::size_t>(size));
      matrix.solve({b.data(), x.size()}, x);
      for (int i = 0; i < size; ++i) {
        EXPECT_NEAR(expected[i], x[static_cast<std::size_t>(i)], 1e-10 * expected.cwiseAbs().maxCoeff())
            << size << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace freeplay
