#include "base/suggestion.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(Suggestion, FindsTheNearestWord) {
  EXPECT_EQ(suggestion("intertia", {"mass", "inertia", "com"}), "inertia");
  EXPECT_EQ(suggestion("clearence", {"length", "clearance"}), "clearance");
}

TEST(Suggestion, TakesTheSmallestDistanceThenTheOrder) {
  EXPECT_EQ(suggestion("leg3", {"leg12", "leg1", "leg2"}), "leg1");
  EXPECT_EQ(suggestion("leg3", {"leg2", "leg1"}), "leg2");
}

TEST(Suggestion, AllowsDistanceThreeFromEightLettersOnly) {
  EXPECT_EQ(suggestion("restXYZion", {"restitution"}), std::nullopt);  // 4 away
  EXPECT_EQ(suggestion("restXYZtion", {"restitution"}), "restitution");
  EXPECT_EQ(suggestion("frXYZon", {"friccon"}), std::nullopt);
}

TEST(Suggestion, OffersAWordThatContainsIt) {
  EXPECT_EQ(suggestion("clearance", {"type", "radial_clearance"}), "radial_clearance");
  EXPECT_EQ(suggestion("mass_of_rod", {"mass"}), "mass");
}

TEST(Suggestion, CountsADifferenceInCaseAsOne) {
  EXPECT_EQ(suggestion("KG", {"g", "kg"}), "kg");
  EXPECT_EQ(suggestion("MASS", {"mass"}), "mass");
}

TEST(Suggestion, OffersNothingUnrelated) {
  EXPECT_EQ(suggestion("x", {"y"}), std::nullopt);
  EXPECT_EQ(suggestion("", {"mass"}), std::nullopt);
  EXPECT_EQ(suggestion(std::string(100000, 'a'), {"mass"}), std::nullopt);
}

}  // namespace
}  // namespace freeplay
