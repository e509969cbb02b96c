#include "results/row_grid.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

using RowNumbers = std::vector<std::size_t>;

TEST(RowGrid, LeavesOutRowsBesideTheGridAndBeforeTheTimeThatCounts) {
  const std::vector<double> time{0.0, 0.1, 0.13, 0.2, 0.30000000000000004, 0.4, 0.45};
  const RowGrid grid = RowGrid::of(time, 0.0, 0.1, 0.1);
  EXPECT_EQ(grid.rows, (RowNumbers{1, 3, 4, 5}));
  EXPECT_EQ(grid.interval, 0.1);
}

TEST(RowGrid, KeepsWhatFollowsTheLastGap) {
  EXPECT_EQ(RowGrid::of(std::vector{0.0, 1.0, 3.0, 4.0, 5.0}, 0.0, 0.0, 1.0).rows, (RowNumbers{2, 3, 4}));
}

TEST(RowGrid, FindsAnIntervalThatIsNotKnown) {
  const RowGrid grid = RowGrid::of(std::vector{2.0, 2.5, 2.51, 3.0, 3.5, 4.0, 4.5}, 2.0, 0.0, 0.0);
  EXPECT_EQ(grid.interval, 0.5);
  EXPECT_EQ(grid.rows, (RowNumbers{0, 1, 3, 4, 5, 6}));
  EXPECT_TRUE(RowGrid::of(std::vector{2.0}, 2.0, 0.0, 0.0).rows.empty());
}

TEST(RowGrid, AllowsTheRoundingOfLateInstants) {
  std::vector<double> time;
  for (int i = 0; i < 100; ++i) time.push_back(1e5 + 1e-6 * i);
  EXPECT_EQ(RowGrid::of(time, 0.0, 0.0, 1e-6).rows.size(), 100u);
}

}  // namespace
}  // namespace freeplay
