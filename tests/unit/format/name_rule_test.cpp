#include "format/name_rule.h"

#include <string>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(NameRule, DistinguishesNamesFromOtherWords) {
  for (const char* good : {"a", "_", "leg-2", "A_b9", "x"}) EXPECT_TRUE(is_name(good)) << good;
  for (const char* bad : {"", "4D", "-a", "a.b", "a/b", "x-note", "ä", "a b"}) EXPECT_FALSE(is_name(bad)) << bad;
  EXPECT_TRUE(is_name(std::string(64, 'a')));
  EXPECT_FALSE(is_name(std::string(65, 'a')));
  EXPECT_FALSE(is_parameter_name("l-2"));
}

}  // namespace
}  // namespace freeplay
