#include "drawing/map_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace freeplay {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

PositionMap small_map() {
  PositionMap map;
  map.title = "a < b";
  map.quantity = "error [um]";
  map.x = {0.0, 0.1, 0.2};
  map.y = {0.0, 0.1};
  map.values = {1.0, 2.0, 3.0, undefined, undefined, 6.0};
  map.points = {MapPoint::good,        MapPoint::good,     MapPoint::good,
                MapPoint::unreachable, MapPoint::singular, MapPoint::good};
  return map;
}

TEST(MapDrawing, SaysWhatItsMarksMean) {
  const std::string text = map_svg(small_map());
  EXPECT_THAT(text, HasSubstr("a &lt; b"));
  EXPECT_THAT(text, HasSubstr("out of reach"));
  EXPECT_THAT(text, HasSubstr("singular"));
  EXPECT_THAT(text, Not(HasSubstr("path, from")));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  EXPECT_EQ(text, map_svg(small_map()));
}

TEST(MapDrawing, HasOnePathForEachToneSoThatNoSeamsShow) {
  PositionMap map = small_map();
  map.points.assign(6, MapPoint::good);
  map.values = {0.0, 1.0, 2.0, 1.0, 2.0, 3.0};
  const std::string text = map_svg(map);
  EXPECT_THAT(text, Not(HasSubstr("crispEdges")));
  EXPECT_THAT(text, HasSubstr("x [mm]"));
  map.coloured = true;
  EXPECT_THAT(map_svg(map), HasSubstr("#fee838"));
}

TEST(MapDrawing, OfNothingReachableIsAllHatched) {
  PositionMap map = small_map();
  map.points.assign(6, MapPoint::unreachable);
  EXPECT_THAT(map_svg(map), HasSubstr("out of reach"));
  EXPECT_THAT(map_svg(map), Not(HasSubstr("nan")));
}

/// A map of x + y, or of what is reached of it: a disc.
PositionMap disc_map(double radius) {
  PositionMap map;
  map.title = map.quantity = "sum";
  for (int i = -10; i <= 10; ++i) map.x.push_back(0.01 * i), map.y.push_back(0.01 * i);
  for (const double x : map.x) {
    for (const double y : map.y) {
      const bool reached = std::hypot(x, y) < radius;
      map.values.push_back(reached ? x + y : undefined);
      map.points.push_back(reached ? MapPoint::good : MapPoint::unreachable);
    }
  }
  return map;
}

/// The numbers of all paths like `pattern`, whose first group they are.
std::vector<std::vector<double>> numbers(const std::string& text, const char* pattern) {
  std::vector<std::vector<double>> all;
  const std::regex path(pattern), number(R"(-?[\d.]+)");
  for (std::sregex_iterator at(text.begin(), text.end(), path), end; at != end; ++at) {
    const std::string d = (*at)[1];
    all.emplace_back();
    for (std::sregex_iterator n(d.begin(), d.end(), number); n != end; ++n) all.back().push_back(std::stod(n->str()));
  }
  return all;
}

TEST(MapDrawing, HasNoStairsAtTheEdgeOfWhatIsReached) {
  const std::string text = map_svg(disc_map(0.083));
  const double scale = 620.0 / 0.2, middle_x = 80.0 + 310.0, middle_y = 50.0 + 310.0;
  const auto radius = [&](double x, double y) { return std::hypot(x - middle_x, y - middle_y) / scale; };
  const auto ends = numbers(text, R"re(<clipPath id="reached"><path d="([^"]*)")re");
  ASSERT_EQ(ends.size(), 1);
  double largest = 0.0;
  for (std::size_t k = 0; k < ends[0].size(); k += 2) largest = std::max(largest, radius(ends[0][k], ends[0][k + 1]));
  EXPECT_LT(largest, 0.088);  // stairs about points have corners at 0.0886 m
  // Contours go on, straight, until there.
  int reaching = 0;
  for (const auto& line : numbers(text, R"re(<path d="([^"]*)" fill="none" stroke="black" stroke-width="0.8")re")) {
    const auto level = [&](std::size_t k) { return (line[k] - middle_x - (line[k + 1] - middle_y)) / scale; };
    for (std::size_t k = 2; k < line.size(); k += 2) EXPECT_NEAR(level(k), level(0), 1e-4);
    if (radius(line[0], line[1]) > 0.083 && radius(line[line.size() - 2], line.back()) > 0.083) ++reaching;
  }
  EXPECT_GT(reaching, 3);
}

TEST(MapDrawing, IsWhiteWhereWhatIsReachedHasNoValue) {
  PositionMap map = disc_map(0.2);
  map.points[220] = MapPoint::singular;
  const std::string text = map_svg(map);
  const auto white = numbers(text, R"re(<path d="([^"]*)" fill="white"/>)re");
  ASSERT_EQ(white.size(), 1);
  EXPECT_EQ(white[0].size(), 8U * 20);  // all of it, a rectangle for each column
  EXPECT_THAT(map_svg(disc_map(0.2)), Not(HasSubstr("clip")));
}

/// A map of x + y with a path along the diagonal of its middle; its contours cross it.
PositionMap crossed_map() {
  PositionMap map;
  map.title = map.quantity = "sum";
  for (int i = 0; i <= 20; ++i) map.x.push_back(0.01 * i), map.y.push_back(0.01 * i);
  for (const double x : map.x) {
    for (const double y : map.y) map.values.push_back(x + y);
    map.path.push_back({x, x});
  }
  map.points.assign(map.values.size(), MapPoint::good);
  return map;
}

TEST(MapDrawing, HasNoLabelUnderItsPath) {
  const PositionMap map = crossed_map();
  const std::string text = map_svg(map);
  const std::regex label(R"re(<text x="([\d.]+)" y="([\d.]+)" text-anchor="middle" stroke="white")re");
  const double scale = 620.0 / 0.2, left = 80.0, top = 50.0;
  int labels = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), label), end; at != end; ++at, ++labels) {
    const double x = (std::stod((*at)[1]) - left) / scale, y = 0.2 - (std::stod((*at)[2]) - 4.0 - top) / scale;
    EXPECT_GT(scale * std::abs(x - y) / std::sqrt(2.0), 12.0) << (*at)[0];
    EXPECT_GT(static_cast<std::size_t>(at->position()), text.find("#0050a0"));
  }
  EXPECT_GT(labels, 3);
}

}  // namespace
}  // namespace freeplay
