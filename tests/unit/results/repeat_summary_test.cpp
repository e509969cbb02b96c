#include "results/repeat_summary.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

Json figures(double force) {
  return {{"joints", {{"B", {{"type", "revolute-clearance"}, {"max_force", force}, {"max_delta", nullptr}}}}},
          {"drivers", {{"motor", {{"kind", "angle"}, {"max_abs", 2.0 * force}}}}}};
}

TEST(RepeatSummary, HasMedianRangeAndAllValues) {
  RepeatSummary summary(4, 7, {.moved = 0.01});
  for (const auto& [run, force] : {std::pair{0u, 3.0}, {1u, 1.0}, {2u, 9.0}, {3u, 5.0}})
    summary.add(run, RepeatSummary::values_of(figures(force)));
  const Json json = summary.json(figures(0.0));
  EXPECT_EQ(Json::parse(R"({"median": 4.0, "min": 1.0, "max": 9.0, "values": [3.0, 1.0, 9.0, 5.0]})"),
            json["joints"]["B"]["max_force"]);
  EXPECT_EQ(8.0, json["drivers"]["motor"]["max_abs"]["median"]);
  EXPECT_TRUE(json["joints"]["B"]["max_delta"]["median"].is_null());
  EXPECT_FALSE(json["joints"]["B"].contains("type"));
  EXPECT_EQ(4, json["completed"]);
  EXPECT_EQ(7, json["seed"]);
}

TEST(RepeatSummary, IsTheSameInWhateverOrderRunsCome) {
  RepeatSummary one(3, 1, {.moved = 0.01}), other(3, 1, {.moved = 0.01});
  for (const std::size_t run : {0u, 1u, 2u}) one.add(run, RepeatSummary::values_of(figures(static_cast<double>(run))));
  for (const std::size_t run : {2u, 0u, 1u})
    other.add(run, RepeatSummary::values_of(figures(static_cast<double>(run))));
  EXPECT_EQ(one.json(figures(0.0)).dump(), other.json(figures(0.0)).dump());
}

TEST(RepeatSummary, ARunThatFailedCostsNoOther) {
  RepeatSummary summary(3, 1, {.moved = 0.01});
  summary.add(2, RepeatSummary::values_of(figures(5.0)));
  summary.fail(1, 4, "no step could be made");
  summary.add(0, RepeatSummary::values_of(figures(4.0)));
  const Json json = summary.json(figures(0.0));
  EXPECT_EQ(Json::parse("[4.0, null, 5.0]"), json["joints"]["B"]["max_force"]["values"]);
  EXPECT_EQ(4.5, json["joints"]["B"]["max_force"]["median"]);
  EXPECT_EQ(Json::parse(R"([{"run": 2, "exit_code": 4, "reason": "no step could be made"}])"), json["failed"]);
  EXPECT_EQ(2, json["completed"]);
}

}  // namespace
}  // namespace freeplay
