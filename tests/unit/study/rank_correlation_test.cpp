#include "study/rank_correlation.h"

#include <limits>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

const std::vector<std::string> together(4);

TEST(RankCorrelation, IsOneWhereBothGoUp) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {1, 10, 100, 1000}, together), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {4, 3, 2, 1}, together), -1.0);
}

TEST(RankCorrelation, OfTiesAndOneValueIsNothing) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {5, 5, 5, 5}, together), 0.0);
  EXPECT_DOUBLE_EQ(rank_correlation({1}, {1}, {""}), 0.0);
  EXPECT_DOUBLE_EQ(rank_correlation({}, {}, {}), 0.0);
}

// Both are larger in the second combination; within each one goes up while the other goes down.
TEST(RankCorrelation, DoesNotSeeWhatDiffersBetweenCombinations) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 11, 12}, {2, 1, 22, 21}, {"a", "a", "b", "b"}), -1.0);
}

TEST(RankCorrelation, DoesNotCountRowsThatLackANumber) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, none, 4}, {1, 2, -9, 4}, together), 1.0);
}

}  // namespace
}  // namespace freeplay
