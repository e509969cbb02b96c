#include "report/orbit.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "report/base64.h"

namespace freeplay {
namespace {

std::string rows(std::vector<std::int32_t> numbers) { return base64_numbers<std::int32_t>(numbers); }

TEST(Orbit, KeepsAllPointsWhereThereIsRoom) {
  Orbit orbit("A", 2.0, false, 2, 2);
  orbit.add({1.0, 2.0, 0.0});
  orbit.add({-2.0, 0.0, 0.0});
  const Json json = orbit.json();
  EXPECT_EQ(json["joint"], "A");
  EXPECT_EQ(json["rows"], rows({0, 1}));
  EXPECT_EQ(json["points"], base64_numbers<float>(std::vector{0.5f, 1.0f, -1.0f, 0.0f}));
  EXPECT_FALSE(json.contains("radius"));
}

TEST(Orbit, KeepsTheFirstAndTheFarthestPointOfEachPart) {
  Orbit orbit("A", 1.0, false, 8, 4);  // two parts of four rows
  for (const double x : {0.1, 0.2, 0.9, 0.3, 0.8, 0.4, 0.5, 0.6}) orbit.add({x, 0.0, 0.0});
  EXPECT_EQ(orbit.json()["rows"], rows({0, 2, 4}));
}

TEST(Orbit, LeavesOutPointsWithoutNumbers) {
  Orbit orbit("A", 1.0, false, 6, 2);
  for (const double x : {std::nan(""), 0.2, 0.9, 0.3, std::nan(""), 0.4}) orbit.add({x, 0.0, 0.0});
  EXPECT_EQ(orbit.json()["rows"], rows({1, 2}));
}

TEST(Orbit, InSpaceHasTheDistanceOfEachPoint) {
  Orbit orbit("A", 2.0, true, 1, 1);
  orbit.add({1.0, 2.0, 2.0});
  EXPECT_EQ(orbit.json()["radius"], base64_numbers<float>(std::vector{1.5f}));
}

}  // namespace
}  // namespace freeplay
