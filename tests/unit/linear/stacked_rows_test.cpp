#include "linear/stacked_rows.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(StackedRows, LaterRowsAreSolvedInWhatEarlierOnesLeaveFree) {
  StackedRows stack(3);
  stack.add(MatrixXd{{1.0, 1.0, 0.0}}, VectorXd{{2.0}});
  stack.add(MatrixXd{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, VectorXd{{5.0, 0.0}});  // contradicts it: least squares
  stack.add(MatrixXd{{1.0, 0.0, 1.0}}, VectorXd{{4.0}});
  EXPECT_NEAR(stack.solution()[0], 3.5, 1e-14);
  EXPECT_NEAR(stack.solution()[1], -1.5, 1e-14);
  EXPECT_NEAR(stack.solution()[2], 0.5, 1e-14);
  EXPECT_EQ(stack.free().cols(), 0);
}

TEST(StackedRows, WhatNoRowNamesStaysZeroAndFree) {
  StackedRows stack(2);
  stack.add(MatrixXd{{0.0, 3.0}, {0.0, 3.0}}, VectorXd{{6.0, 6.0}});
  EXPECT_NEAR(stack.solution()[0], 0.0, 1e-15);
  EXPECT_NEAR(stack.solution()[1], 2.0, 1e-15);
  ASSERT_EQ(stack.free().cols(), 1);
  EXPECT_NEAR(std::abs(stack.free()(0, 0)), 1.0, 1e-15);
}

// The second row is all but the first: to fulfil it, x would have to be 10 000.
TEST(StackedRows, DirectionsThatEarlierRanksHardlyLeaveFreeCountAsNone) {
  StackedRows all(2), stable(2);
  const MatrixXd first{{1.0, 0.0}}, second{{1.0, 1e-4}};
  const VectorXd none{{0.0}}, one{{1.0}};
  all.add(first, none);
  all.add(second, one);
  EXPECT_NEAR(all.solution()[1], 1e4, 1e-6);
  stable.add(first, none);
  stable.add(second, one, 1e-2);
  EXPECT_EQ(stable.solution()[1], 0.0);
  EXPECT_EQ(stable.free().cols(), 1);
}

}  // namespace
}  // namespace freeplay
