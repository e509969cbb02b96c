#include "base/name_pattern.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(NamePattern, StarsStandForAnyCharacters) {
  EXPECT_TRUE(matches("leg*.A", "leg12.A"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("a*b*c", "a.b.b.c"));
  EXPECT_TRUE(matches("abc", "abc"));
  EXPECT_FALSE(matches("leg*.A", "leg1.B"));
  EXPECT_FALSE(matches("a*", "ba"));
  EXPECT_FALSE(matches("", "a"));
}

}  // namespace
}  // namespace freeplay
