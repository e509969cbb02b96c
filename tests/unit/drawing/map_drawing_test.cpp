#include "drawing/map_drawing.h"

#include <cmath>
#include <limits>
#include <regex>
#include <string>

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
