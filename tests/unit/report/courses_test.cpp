#include "report/courses.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "report/base64.h"

namespace freeplay {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Courses filled(std::vector<double> values, std::size_t buckets) {
  Courses courses(1, values.size(), buckets);
  for (std::size_t i = 0; i < values.size(); ++i) courses.row(std::vector{0.5 * static_cast<double>(i), values[i]});
  return courses;
}

Json described(const Courses& courses) {
  Json json;
  courses.describe(0, json);
  return json;
}

TEST(Courses, HoldMinimumAndMaximumOfEachBucket) {
  // Seven rows in three buckets: rows 0 to 1, 2 to 3, 4 to 6.
  const Courses courses = filled({1.0, 3.0, -2.0, 4.0, 0.0, 8.0, 2.0}, 3);
  const Json json = described(courses);
  EXPECT_EQ(json["offset"], 3.0);
  EXPECT_EQ(json["values"], base64_floats(std::vector{1.0, 3.0, -2.0, 4.0, 0.0, 8.0}, 3.0));
  EXPECT_EQ(json["min"], -2.0);
  EXPECT_EQ(json["min_time"], 1.0);
  EXPECT_EQ(json["max"], 8.0);
  EXPECT_EQ(json["max_time"], 2.5);
  EXPECT_EQ(courses.times(), base64_numbers<double>(std::vector{0.0, 1.0, 2.0, 3.0}));
}

TEST(Courses, HoldRowsWhereThereAreNoBuckets) {
  const Courses courses = filled({1.0, 3.0, 2.0}, 0);
  EXPECT_EQ(described(courses)["values"], base64_floats(std::vector{1.0, 3.0, 2.0}, 2.0));
  EXPECT_EQ(courses.times(), base64_numbers<double>(std::vector{0.0, 0.5, 1.0}));
}

TEST(Courses, CountNaNForNeitherExtreme) {
  const Json json = described(filled({nan, 2.0, nan, nan}, 2));
  EXPECT_EQ(json["values"], base64_floats(std::vector{2.0, 2.0, nan, nan}, 2.0));
  EXPECT_EQ(json["max_time"], 0.5);
}

TEST(Courses, OfNothingButNaNHaveNoExtremes) {
  const Json json = described(filled({nan, nan}, 0));
  EXPECT_TRUE(json["min"].is_null());
  EXPECT_TRUE(json["max_time"].is_null());
  EXPECT_EQ(json["offset"], 0.0);
}

TEST(Courses, TakeTheFirstOfEqualExtremes) {
  const Json json = described(filled({5.0, 1.0, 5.0, 1.0}, 0));
  EXPECT_EQ(json["max_time"], 0.0);
  EXPECT_EQ(json["min_time"], 0.5);
}

}  // namespace
}  // namespace freeplay
