#include "drawing/map_drawing.h"

#include <cmath>
#include <limits>

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

}  // namespace
}  // namespace freeplay
