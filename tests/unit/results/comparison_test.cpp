#include "results/comparison.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

namespace freeplay {
namespace {

const double nothing = std::nan("");

ResultTable table(const std::string& file, std::vector<double> time, std::vector<double> x,
                  std::vector<double> y = {}) {
  ResultTable t{file, {"time", "body.a.x"}, {std::move(time), std::move(x)}};
  if (!y.empty()) t.names.push_back("body.a.y"), t.values.push_back(std::move(y));
  return t;
}

TEST(Compare, EqualResultsAgreeWithoutAnyAllowance) {
  const ResultTable a = table("a", {0, 1, 2}, {1, nothing, 3});
  const Comparison c = compare(a, a, {.relative = 0.0, .absolute = 0.0});
  EXPECT_TRUE(c.agree());
  EXPECT_EQ(c.rows, 3u);
  EXPECT_FALSE(c.interpolated);
}

TEST(Compare, ToleranceIsAPartOfTheLargestValueOfA) {
  const ResultTable a = table("a", {0, 1, 2}, {1, -4, 2}), b = table("b", {0, 1, 2}, {1, -4, 2.4});
  const Comparison c = compare(a, b, {.relative = 0.1, .absolute = 0.0});
  EXPECT_TRUE(c.agree());  // 0.4 <= 0.1 4
  EXPECT_FALSE(compare(a, b, {.relative = 0.0999, .absolute = 0.0}).agree());
  EXPECT_TRUE(compare(a, b, {.relative = 0.0, .absolute = 0.41}).agree());
  ASSERT_EQ(c.channels.size(), 1u);
  EXPECT_NEAR(c.channels[0].largest, 0.4, 1e-15);
  EXPECT_NEAR(c.channels[0].relative, 0.1, 1e-15);
  EXPECT_NEAR(c.channels[0].rms, 0.4 / std::sqrt(3.0), 1e-15);
  EXPECT_EQ(c.channels[0].at_time, 2.0);
}

TEST(Compare, WorstChannelComesFirst) {
  const ResultTable a = table("a", {0, 1}, {1, 1}, {1, 1}), b = table("b", {0, 1}, {1, 1.1}, {1, 1.5});
  const Comparison c = compare(a, b, {});
  EXPECT_EQ(c.channels[0].name, "body.a.y");
  EXPECT_EQ(c.channels[1].name, "body.a.x");
}

TEST(Compare, InterpolatesTheSecondResultWhereItsTimesDiffer) {
  const ResultTable a = table("a", {0, 0.5, 1}, {0, 0.5, 1}), b = table("b", {0, 0.25, 1}, {0, 0.25, 1});
  const Comparison c = compare(a, b, {});
  EXPECT_TRUE(c.interpolated);
  EXPECT_TRUE(c.agree());
}

TEST(Compare, TimesThatDifferByRoundingAreTheSame) {
  const ResultTable a = table("a", {0, 1, 2}, {0, 1, 0}), b = table("b", {0, 1 + 5e-10, 2}, {0, 1, 0});
  const Comparison c = compare(a, b, {.relative = 0.0, .absolute = 0.0});
  EXPECT_FALSE(c.interpolated);
  EXPECT_TRUE(c.agree());
}

TEST(Compare, MissingRowsAndChannelsDiffer) {
  const ResultTable a = table("a", {0, 1, 2}, {1, 1, 1}), shorter = table("b", {0, 1}, {1, 1});
  EXPECT_FALSE(compare(a, shorter, {}).agree());
  EXPECT_FALSE(compare(shorter, a, {}).agree());
  EXPECT_TRUE(compare(a, shorter, {.until = 1.0}).agree());
  const ResultTable more = table("c", {0, 1, 2}, {1, 1, 1}, {2, 2, 2});
  EXPECT_FALSE(compare(a, more, {}).agree());
  EXPECT_FALSE(compare(more, a, {}).agree());
  EXPECT_TRUE(compare(more, a, {.channels = {"*.x"}}).agree());
}

TEST(Compare, ANumberIsNotAnEmptyField) {
  const ResultTable a = table("a", {0, 1}, {1, 1}), b = table("b", {0, 1}, {1, nothing});
  EXPECT_FALSE(compare(a, b, {}).agree());
  EXPECT_FALSE(compare(b, a, {}).agree());
}

TEST(Compare, NoCommonRowsDiffer) {
  EXPECT_FALSE(compare(table("a", {0, 1}, {1, 1}), table("b", {2, 3}, {1, 1}), {}).agree());
}

TEST(Compare, PatternThatFitsNothingIsRefused) {
  const ResultTable a = table("a", {0, 1}, {1, 1});
  EXPECT_THROW(compare(a, a, {.channels = {"joint.*"}}), Error);
}

}  // namespace
}  // namespace freeplay
