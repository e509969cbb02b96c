#include "linear/least_squares.h"

#include <vector>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(LeastSquares, SolvesRowsThatAgree) {
  LeastSquares solver(3, 2);
  solver.matrix << 1, 2, 3, -1, 4, 1;  // the last row is the sum of the others
  ASSERT_TRUE(solver.factor());
  std::vector<double> x(2);
  solver.solve(std::vector<double>{8.0, 3.0, 11.0}, x);  // 8 = 2 + 2 * 3, 3 = 3 * 2 - 3
  EXPECT_NEAR(x[0], 2.0, 1e-14);
  EXPECT_NEAR(x[1], 3.0, 1e-14);
}

TEST(LeastSquares, MinimisesWhatRowsDisagreeOn) {
  LeastSquares solver(3, 1);
  solver.matrix << 1, 1, 1;
  ASSERT_TRUE(solver.factor());
  std::vector<double> mean(1);
  solver.solve(std::vector<double>{1.0, 2.0, 6.0}, mean);
  EXPECT_NEAR(mean[0], 3.0, 1e-15);
}

TEST(LeastSquares, RefusesDependentColumnsAndFlatMatrices) {
  LeastSquares dependent(3, 2), flat(1, 2);
  dependent.matrix << 1, 2, 2, 4, 3, 6;
  flat.matrix << 1, 0;
  EXPECT_FALSE(dependent.factor());
  EXPECT_FALSE(flat.factor());
}

}  // namespace
}  // namespace freeplay
