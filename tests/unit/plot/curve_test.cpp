#include "plot/curve.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace freeplay::plot {
namespace {

TEST(ColumnCurve, KeepsTheExtremesOfEveryColumnInOrderOfTheirPlace) {
  ColumnCurve curve(0.0, 2.0, 2);
  for (const Point& point : {Point{0.0, 1.0}, Point{0.2, 5.0}, Point{0.4, -3.0}, Point{0.9, 0.0}, Point{1.5, 2.0}}) {
    curve.add(point);
  }
  const std::vector<Point>& points = curve.points();
  ASSERT_EQ(3u, points.size());
  EXPECT_EQ(0.2, points[0].x);
  EXPECT_EQ(5.0, points[0].y);
  EXPECT_EQ(0.4, points[1].x);
  EXPECT_EQ(-3.0, points[1].y);
  EXPECT_EQ(1.5, points[2].x);
}

TEST(ColumnCurve, LeavesAGapWhereThereIsNoNumber) {
  ColumnCurve curve(0.0, 10.0, 10);
  for (const Point& point : {Point{0.5, 1.0}, Point{1.5, NAN}, Point{2.5, NAN}, Point{3.5, 2.0}}) curve.add(point);
  const std::vector<Point>& points = curve.points();
  ASSERT_EQ(3u, points.size());
  EXPECT_TRUE(std::isnan(points[1].y));
  EXPECT_EQ(2.0, points[2].y);
}

TEST(ColumnCurve, HasNoMorePointsForMoreRows) {
  ColumnCurve curve(0.0, 1.0, 100);
  for (int i = 0; i < 100000; ++i) curve.add({i * 1e-5, std::sin(i * 0.7)});
  EXPECT_LE(curve.points().size(), 200u);
}

TEST(Trail, LeavesOutAWayThatWasDrawnBefore) {
  Trail trail(0.01, 0.01);
  const auto turn = [&] {
    for (int i = 0; i < 100; ++i) trail.add({std::cos(2.0 * M_PI * i / 100), std::sin(2.0 * M_PI * i / 100)});
  };
  turn();
  turn();
  const std::size_t once = trail.points().size();
  EXPECT_GE(once, 100u);
  for (int i = 0; i < 10; ++i) turn();
  EXPECT_EQ(once, trail.points().size());
}

TEST(Trail, OfVeryManyWaysKeepsExtremesAndStaysSmall) {
  Trail trail(0.002, 0.002);
  Extremes all, kept;
  std::uint64_t seed = 1;
  const auto random = [&] {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(seed >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 300000; ++i) {
    const Point point{random(), random()};
    all.add(0.0, point.x);
    trail.add(point);
  }
  for (const Point& point : trail.points()) {
    if (!std::isnan(point.y)) kept.add(0.0, point.x);
  }
  EXPECT_EQ(all.most, kept.most);
  EXPECT_EQ(all.least, kept.least);
  EXPECT_LT(trail.points().size(), 120000u);
}

}  // namespace
}  // namespace freeplay::plot
