#include "linear/kkt_matrix.h"

#include <vector>

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

}  // namespace
}  // namespace freeplay
