#include "assembly/drive_range.h"

#include <limits>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(DriveRange, IsSaidInTheUnitsOfItsCoordinate) {
  EXPECT_EQ(words({-1.5, 0.5}, Coordinate::angle), "turn from -85.94 deg to 28.65 deg");
  EXPECT_EQ(words({0.1, 0.25}, Coordinate::position), "move from 0.1 m to 0.25 m");
  EXPECT_EQ(words({-infinite, 0.25}, Coordinate::position), "move up to 0.25 m");
  EXPECT_EQ(words({1.0, infinite}, Coordinate::angle), "turn down to 57.3 deg");
}

TEST(DriveRange, OfOnePlaceIsNoWay) {
  EXPECT_EQ(words({3.141592, 3.141593}, Coordinate::angle), "hardly turn from 180 deg");
}

}  // namespace
}  // namespace freeplay
