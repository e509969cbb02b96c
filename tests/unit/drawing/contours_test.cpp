#include "drawing/contours.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

namespace freeplay {
namespace {

using ::testing::ElementsAre;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Contour, OfAPlaneIsItsLine) {
  // z = x + 2 y at level 1.25.
  const std::vector<double> x{0.0, 0.5, 1.0}, y{0.0, 0.4, 1.0};
  std::vector<double> z;
  for (const double a : x) {
    for (const double b : y) z.push_back(a + 2.0 * b);
  }
  const auto pieces = contour(x, y, z, 1.25);
  EXPECT_FALSE(pieces.empty());
  double length = 0.0;
  for (const auto& [x0, y0, x1, y1] : pieces) {
    EXPECT_NEAR(x0 + 2.0 * y0, 1.25, 1e-14);
    EXPECT_NEAR(x1 + 2.0 * y1, 1.25, 1e-14);
    length += std::hypot(x1 - x0, y1 - y0);
  }
  EXPECT_NEAR(length, std::hypot(1.0, 0.5), 1e-14);
}

TEST(Contour, OfASaddleDoesNotCross) {
  // Corners 1 and -1 crosswise; the mean decides which hang together.
  const auto low = contour({0.0, 1.0}, {0.0, 1.0}, {1.0, -2.0, -2.0, 1.0}, 0.0);
  ASSERT_EQ(low.size(), 2u);
  for (const auto& [x0, y0, x1, y1] : low) EXPECT_NEAR(std::hypot(x1 - x0, y1 - y0), std::sqrt(2.0) / 3.0, 1e-14);
  const auto high = contour({0.0, 1.0}, {0.0, 1.0}, {2.0, -1.0, -1.0, 2.0}, 0.0);
  ASSERT_EQ(high.size(), 2u);
  for (const auto& [x0, y0, x1, y1] : high) EXPECT_NEAR(std::hypot(x1 - x0, y1 - y0), std::sqrt(2.0) / 3.0, 1e-14);
}

TEST(Contour, LeavesOutCellsWithoutValues) {
  EXPECT_TRUE(contour({0.0, 1.0}, {0.0, 1.0}, {1.0, -1.0, nan, 1.0}, 0.0).empty());
}

double area(const std::vector<svg::Point>& polygon) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) twice += svg::cross(polygon[k], polygon[(k + 1) % polygon.size()]);
  return 0.5 * twice;
}

TEST(Region, OfAPlaneIsWhatLiesAboveItsLine) {
  double sum = 0.0;
  for (const auto& polygon : region({0.0, 1.0, 2.0}, {0.0, 1.0}, {0.0, 0.0, 1.0, 1.0, 2.0, 2.0}, 0.5, 9.0))
    sum += area(polygon);
  EXPECT_DOUBLE_EQ(1.5, sum);
}

TEST(Region, OfASaddleAgreesWithItsContour) {
  const std::vector<double> x{0.0, 1.0}, y{0.0, 1.0};
  EXPECT_EQ(2u, region(x, y, {1.0, -2.0, -2.0, 1.0}, 0.0, 9.0).size());
  const auto connected = region(x, y, {2.0, -1.0, -1.0, 2.0}, 0.0, 9.0);
  ASSERT_EQ(1u, connected.size());
  EXPECT_EQ(6u, connected[0].size());
}

TEST(Region, LeavesOutWhatTheNextLevelCovers) {
  EXPECT_EQ(1u, region({0.0, 1.0, 2.0}, {0.0, 1.0}, {0.0, 0.0, 1.0, 1.0, 2.0, 2.0}, 0.5, 1.0).size());
}

TEST(ContourLevels, AreRoundNumbers) {
  EXPECT_THAT(contour_levels(0.3, 7.4, false), ElementsAre(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0));
  EXPECT_THAT(contour_levels(3.0, 150.0, true), ElementsAre(5.0, 10.0, 20.0, 50.0, 100.0));
  EXPECT_TRUE(contour_levels(1.0, 1.0, false).empty());
}

}  // namespace
}  // namespace freeplay
