#include "base/text.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(Text, CountsCharactersNotBytes) {
  EXPECT_EQ(character_count("abc"), 3);
  EXPECT_EQ(character_count("\u00b5m"), 2);
  EXPECT_EQ(character_count("\xff\xfe"), 2);
  EXPECT_EQ(character_count("\U0001F600"), 1);
}

TEST(Text, KnowsInvalidUtf8) {
  EXPECT_EQ(character_bytes("\xc0\x80", 0), 0u);          // overlong
  EXPECT_EQ(character_bytes("\xed\xa0\x80", 0), 0u);      // surrogate
  EXPECT_EQ(character_bytes("\xf4\x90\x80\x80", 0), 0u);  // beyond U+10FFFF
  EXPECT_EQ(character_bytes("\xe2\x82", 0), 0u);          // cut
  EXPECT_EQ(character_bytes("\xe2\x82\xac", 0), 3u);
}

TEST(Text, PrintsNothingThatSteersATerminal) {
  EXPECT_EQ(printable("a\tb"), "a b");
  EXPECT_EQ(printable("\x1b[31m"), "?[31m");
  EXPECT_EQ(printable("\u009b1m\u202e\u00b5\x80"), "?1m?\u00b5?");
}

}  // namespace
}  // namespace freeplay
