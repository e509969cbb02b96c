// Sets are named by their smallest member, in whatever order they were united.
#include "base/disjoint_sets.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(DisjointSets, AreNamedByTheirSmallestMember) {
  DisjointSets sets(6);
  EXPECT_TRUE(sets.unite(5, 4));
  EXPECT_TRUE(sets.unite(2, 3));
  EXPECT_TRUE(sets.unite(4, 2));
  EXPECT_EQ(sets.root(5), 2);
  EXPECT_EQ(sets.root(3), 2);
  EXPECT_EQ(sets.root(1), 1);
}

TEST(DisjointSets, TellWhetherTwoWereTogetherAlready) {
  DisjointSets sets(3);
  EXPECT_FALSE(sets.together(0, 2));
  EXPECT_TRUE(sets.unite(0, 1));
  EXPECT_TRUE(sets.unite(1, 2));
  EXPECT_FALSE(sets.unite(2, 0));
  EXPECT_TRUE(sets.together(0, 2));
}

}  // namespace
}  // namespace freeplay
