#include "run/area.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

Area of_sine(int steps, double stretched) {
  Area area;
  for (int i = 0; i <= steps; ++i) {
    // Steps that grow and shrink by a part.
    const double s = static_cast<double>(i) / steps,
                 t = M_PI * (s + stretched * std::sin(2.0 * M_PI * s) / (2.0 * M_PI));
    i == 0 ? area.begin(t, 0.0, false) : area.add(t, std::sin(t));
  }
  return area;
}

TEST(Area, OfAParabolaIsExactWhateverTheSteps) {
  Area area;
  area.begin(0.0, 1.0, false);
  for (const double t : {0.1, 0.4, 0.45, 1.0, 1.2}) area.add(t, 1.0 + 2.0 * t + 3.0 * t * t);
  EXPECT_NEAR(area.value(), 1.2 + 1.44 + 1.728, 1e-14);
}

TEST(Area, ErrsWithTheFourthPowerOfTheSteps) {
  for (const double stretched : {0.0, 0.3}) {
    const double coarse = of_sine(20, stretched).value() - 2.0, fine = of_sine(40, stretched).value() - 2.0;
    EXPECT_LT(std::abs(coarse), 3e-4);
    EXPECT_GT(std::log2(coarse / fine), 3.7) << stretched;
  }
}

TEST(Area, OfTwoPointsIsTheTrapezoidAndOfOneNothing) {
  Area area;
  EXPECT_EQ(area.value(), 0.0);
  area.begin(1.0, 2.0, false);
  EXPECT_EQ(area.value(), 0.0);
  area.add(1.5, 4.0);
  EXPECT_EQ(area.value(), 1.5);
}

TEST(Area, OpenStartIsOnTheLineThroughWhatFollowsButOfNoOtherSign) {
  Area jumps, grows;
  jumps.begin(0.0, 0.0, true);  // 5 - t
  for (const double t : {0.5, 1.0}) jumps.add(t, 5.0 - t);
  EXPECT_NEAR(jumps.value(), 4.5, 1e-15);
  grows.begin(0.0, 0.0, true);  // t^2 has a slope of its own there
  for (const double t : {0.5, 1.0}) grows.add(t, t * t);
  EXPECT_NEAR(grows.value(), 1.0 / 3.0, 1e-15);
}

}  // namespace
}  // namespace freeplay
