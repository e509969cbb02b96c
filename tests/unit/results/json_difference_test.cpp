#include "results/json_difference.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(JsonDifference, NamesThePlaceAndBothValues) {
  const Json then{{"a", 1}, {"b", {{"c", {1, 2, 3}}, {"d", "x"}}}};
  Json now = then;
  EXPECT_EQ("", first_difference(then, now, {}));
  now["b"]["c"][1] = 2.5;
  EXPECT_EQ("/b/c/1: 2 recorded, 2.5 now", first_difference(then, now, {}));
  now["b"]["c"] = {1, 2};
  EXPECT_EQ("/b/c: [1,2,3] recorded, [1,2] now", first_difference(then, now, {}));
  now = then;
  now["b"].erase("d");
  EXPECT_EQ("/b/d: \"x\" recorded, nothing now", first_difference(then, now, {}));
  EXPECT_EQ("/b/d: nothing recorded, \"x\" now", first_difference(now, then, {}));
}

TEST(JsonDifference, LeavesOutWhatIsNotLookedAt) {
  const Json then{{"performance", {{"wall", 1.0}}}, {"runs", {{{"name", "a"}, {"n", 1}}}}};
  const Json now{{"runs", {{{"name", "b"}, {"n", 1}}}}};
  EXPECT_EQ("", first_difference(then, now, {"/performance", "/runs/*/name"}));
  EXPECT_EQ("/runs/0/name: \"a\" recorded, \"b\" now", first_difference(then, now, {"/performance"}));
  EXPECT_EQ(1u, count_numbers(then, {"/performance"}));
  EXPECT_EQ(2u, count_numbers(then, {}));
}

}  // namespace
}  // namespace freeplay
