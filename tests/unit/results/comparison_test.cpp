#include "results/comparison.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

namespace freeplay {
namespace {

const double nothing = std::nan("");

/// Rows in memory, which come two at a time.
class Rows : public ResultReader {
 public:
  Rows(const std::string& file, std::vector<std::string> names, std::vector<std::vector<double>> values)
      : ResultReader(file), values_(std::move(values)) {
    for (std::string& name : names) layout_.columns.push_back({std::move(name), "", "", ""});
  }

  std::unique_ptr<RowSource> open_rows(std::span<const std::size_t> columns) override {
    return std::make_unique<Source>(*this, std::vector(columns.begin(), columns.end()));
  }
  void events(const Take&) override {}

 private:
  struct Source : RowSource {
    Source(Rows& rows, std::vector<std::size_t> columns) : of(rows), picked(std::move(columns)) {}
    std::span<const double> next() override {
      block.clear();
      for (const std::size_t last = row + 2; row < last && row < of.values_[0].size(); ++row) {
        for (const std::size_t column : picked) block.push_back(of.values_[column][row]);
      }
      return block;
    }
    Rows& of;
    std::vector<std::size_t> picked;
    std::size_t row = 0;
    std::vector<double> block;
  };
  std::vector<std::vector<double>> values_;
};

Rows table(const std::string& file, std::vector<double> time, std::vector<double> x, std::vector<double> y = {}) {
  if (y.empty()) return {file, {"time", "body.a.x"}, {std::move(time), std::move(x)}};
  return {file, {"time", "body.a.x", "body.a.y"}, {std::move(time), std::move(x), std::move(y)}};
}

Comparison compared(Rows a, Rows b, const ComparisonRules& rules = {}) { return compare(a, b, rules); }

TEST(Compare, EqualResultsAgreeWithoutAnyAllowance) {
  const Rows a = table("a", {0, 1, 2}, {1, nothing, 3});
  const Comparison c = compared(a, a, {.relative = 0.0, .absolute = 0.0});
  EXPECT_TRUE(c.agree());
  EXPECT_EQ(c.rows, 3u);
  EXPECT_FALSE(c.interpolated);
}

TEST(Compare, ToleranceIsAPartOfTheLargestValueOfA) {
  const Rows a = table("a", {0, 1, 2}, {1, -4, 2}), b = table("b", {0, 1, 2}, {1, -4, 2.4});
  const Comparison c = compared(a, b, {.relative = 0.1, .absolute = 0.0});
  EXPECT_TRUE(c.agree());  // 0.4 <= 0.1 4
  EXPECT_FALSE(compared(a, b, {.relative = 0.0999, .absolute = 0.0}).agree());
  EXPECT_TRUE(compared(a, b, {.relative = 0.0, .absolute = 0.41}).agree());
  ASSERT_EQ(c.channels.size(), 1u);
  EXPECT_NEAR(c.channels[0].largest, 0.4, 1e-15);
  EXPECT_NEAR(c.channels[0].relative, 0.1, 1e-15);
  EXPECT_NEAR(c.channels[0].rms, 0.4 / std::sqrt(3.0), 1e-15);
  EXPECT_EQ(c.channels[0].at_time, 2.0);
}

TEST(Compare, WorstChannelComesFirst) {
  const Rows a = table("a", {0, 1}, {1, 1}, {1, 1}), b = table("b", {0, 1}, {1, 1.1}, {1, 1.5});
  const Comparison c = compared(a, b, {});
  EXPECT_EQ(c.channels[0].name, "body.a.y");
  EXPECT_EQ(c.channels[1].name, "body.a.x");
}

TEST(Compare, InterpolatesTheSecondResultWhereItsTimesDiffer) {
  const Rows a = table("a", {0, 0.5, 1}, {0, 0.5, 1}), b = table("b", {0, 0.25, 1}, {0, 0.25, 1});
  const Comparison c = compared(a, b, {});
  EXPECT_TRUE(c.interpolated);
  EXPECT_TRUE(c.agree());
}

TEST(Compare, TimesThatDifferByRoundingAreTheSame) {
  const Rows a = table("a", {0, 1, 2}, {0, 1, 0}), b = table("b", {0, 1 + 5e-10, 2}, {0, 1, 0});
  const Comparison c = compared(a, b, {.relative = 0.0, .absolute = 0.0});
  EXPECT_FALSE(c.interpolated);
  EXPECT_TRUE(c.agree());
}

TEST(Compare, MissingRowsAndChannelsDiffer) {
  const Rows a = table("a", {0, 1, 2}, {1, 1, 1}), shorter = table("b", {0, 1}, {1, 1});
  EXPECT_FALSE(compared(a, shorter, {}).agree());
  EXPECT_FALSE(compared(shorter, a, {}).agree());
  EXPECT_TRUE(compared(a, shorter, {.until = 1.0}).agree());
  const Rows more = table("c", {0, 1, 2}, {1, 1, 1}, {2, 2, 2});
  EXPECT_FALSE(compared(a, more, {}).agree());
  EXPECT_FALSE(compared(more, a, {}).agree());
  EXPECT_TRUE(compared(more, a, {.channels = {"*.x"}}).agree());
}

TEST(Compare, ANumberIsNotAnEmptyField) {
  const Rows a = table("a", {0, 1}, {1, 1}), b = table("b", {0, 1}, {1, nothing});
  EXPECT_FALSE(compared(a, b, {}).agree());
  EXPECT_FALSE(compared(b, a, {}).agree());
}

TEST(Compare, NoCommonRowsDiffer) {
  EXPECT_FALSE(compared(table("a", {0, 1}, {1, 1}), table("b", {2, 3}, {1, 1}), {}).agree());
}

TEST(Compare, DistanceOfAPlaceIsThatOfItsVector) {
  const Comparison c =
      compared(table("a", {0, 1, 2}, {0, 1, 0}, {0, 0, 2}), table("b", {0, 1, 2}, {0, 4, 0}, {0, 4, 2}));
  ASSERT_EQ(c.distances.size(), 1u);
  const Difference& d = c.distances[0];
  EXPECT_EQ(d.name, "body.a.distance");
  EXPECT_EQ(d.largest, 5.0);
  EXPECT_EQ(d.at_time, 1.0);
  EXPECT_EQ(d.relative, 2.5);
  EXPECT_DOUBLE_EQ(d.rms, std::sqrt(25.0 / 3.0));
  EXPECT_FALSE(d.agrees);
  EXPECT_EQ(c.distance.rms, d.rms);
  EXPECT_EQ(c.farthest, "body.a.distance");
}

TEST(Compare, DistanceOfAllIsTheMeanOverBodiesFramesAndRows) {
  const std::vector<std::string> names = {"time",          "body.b.x",      "body.b.y",  "body.b.z",  "frame.b/tip.x",
                                          "frame.b/tip.y", "frame.b/tip.z", "joint.j.x", "joint.j.y", "body.c.x"};
  const std::vector<std::vector<double>> zeros(10, {0, 0});
  std::vector<std::vector<double>> times = zeros, moved = zeros;
  times[0] = moved[0] = {0, 1};
  moved[1] = {2, 0}, moved[2] = {3, 0}, moved[3] = {6, 0};  // length 7
  moved[6] = {0, 8};
  moved[7] = moved[9] = {9, 9};  // neither a body nor a frame; no y
  const Comparison c = compared({"a", names, times}, {"b", names, moved});
  ASSERT_EQ(c.distances.size(), 2u);
  EXPECT_EQ(c.distances[0].name, "frame.b/tip.distance");
  EXPECT_DOUBLE_EQ(c.distances[1].rms, 7.0 / std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(c.distance.rms, std::sqrt((49.0 + 64.0) / 4.0));
  EXPECT_EQ(c.distance.largest, 8.0);
  EXPECT_EQ(c.farthest, "frame.b/tip.distance");
  EXPECT_TRUE(compared({"a", names, times}, {"b", names, moved}, {.channels = {"*.x", "*.y"}}).distances.empty());
}

TEST(Compare, RowsOfBothWithoutAPlaceAreNotApart) {
  const Comparison c =
      compared(table("a", {0, 1}, {1, nothing}, {1, nothing}), table("b", {0, 1}, {1, nothing}, {1, nothing}));
  EXPECT_EQ(c.distance.rms, 0.0);
  const Comparison other = compared(table("a", {0, 1}, {1, 1}, {1, 1}), table("b", {0, 1}, {1, nothing}, {1, 1}));
  EXPECT_TRUE(std::isnan(other.distance.largest));
  EXPECT_TRUE(std::isnan(other.distance.rms));
}

TEST(Compare, BothResultsAreWalkedThroughSideBySide) {
  const Comparison c =
      compared(table("a", {0.5, 1, 2, 2.5, 3}, {0.5, 1, 2, 2.5, 3}),
               table("b", {0, 0.25, 0.75, 1, 1.5, 1.75, 3.5}, {0, 0.25, 0.75, 1, 1.5, 1.75, 3.5}), {.relative = 1e-15});
  EXPECT_EQ(c.rows, 5u);
  EXPECT_TRUE(c.channels[0].agrees);
  EXPECT_EQ(c.missing, std::vector<std::string>{"3 rows of b lie outside the times of a"});
}

TEST(Compare, PatternThatFitsNothingIsRefused) {
  const Rows a = table("a", {0, 1}, {1, 1});
  EXPECT_THROW(compared(a, a, {.channels = {"joint.*"}}), Error);
}

}  // namespace
}  // namespace freeplay
