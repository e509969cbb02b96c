#include "study/distribution.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "study/normal_quantile.h"

namespace freeplay {
namespace {

using Shape = Distribution::Kind;

// Wichura, "The percentage points of the normal distribution" (1988), gives these for PPND16.
TEST(NormalQuantile, GivesThePublishedNumbers) {
  EXPECT_NEAR(normal_quantile(0.25), -0.6744897501960817, 1e-15);
  EXPECT_NEAR(normal_quantile(0.001), -3.090232306167814, 4e-15);
  EXPECT_NEAR(normal_quantile(1e-20), -9.262340089798408, 1e-14);
}

TEST(Quantile, OfPlainDistributionsIsTheClosedForm) {
  EXPECT_EQ(quantile({Shape::uniform, 2, 6}, 0.25), 3.0);
  EXPECT_EQ(quantile({Shape::normal, 10, 2}, 0.5), 10.0);
  EXPECT_NEAR(quantile({Shape::normal, 10, 2}, 0.25), 10 - 2 * 0.6744897501960817, 1e-14);
  // Of the triangle 0, 1, 4 the share below 1 is 1/4; below x > 1 it is 1 - (4 - x)^2 / 12.
  EXPECT_EQ(quantile({Shape::triangular, 0, 1, 4}, 0.25), 1.0);
  EXPECT_EQ(quantile({Shape::triangular, 0, 1, 4}, 0.0625), 0.5);
  EXPECT_NEAR(quantile({Shape::triangular, 0, 1, 4}, 1 - 1.0 / 12), 3.0, 1e-14);
}

TEST(Quantile, OfWhatIsCutStaysBetweenTheEnds) {
  Distribution normal{Shape::normal, 10, 2};
  normal.low = 9;
  normal.high = 11;
  EXPECT_NEAR(quantile(normal, 0.5), 10.0, 1e-14);
  EXPECT_NEAR(quantile(normal, 1e-15), 9.0, 1e-12);
  EXPECT_NEAR(quantile(normal, 1 - 1e-15), 11.0, 1e-12);
  Distribution triangle{Shape::triangular, 0, 1, 4};
  triangle.high = 1;  // what is left has the share x^2 below x
  EXPECT_NEAR(quantile(triangle, 0.25), 0.5, 1e-15);
  Distribution uniform{Shape::uniform, 0, 10};
  uniform.low = 8;
  EXPECT_EQ(quantile(uniform, 0.5), 9.0);
}

// Far out the share below x is lost in rounding unless the upper tail is counted from above.
TEST(Quantile, OfAFarTailIsAsGoodAsThatOfTheOther) {
  Distribution low{Shape::normal, 0, 1}, high{Shape::normal, 0, 1};
  low.high = -9;
  high.low = 9;
  EXPECT_EQ(quantile(high, 0.25), -quantile(low, 0.75));
  EXPECT_GT(quantile(high, 0.999), 9.5);
}

// So far out that no share is left between the ends: the tail falls off as exp(-x^2/2) from the near end.
TEST(Quantile, OfATailWithoutAShareIsAtItsNearEnd) {
  Distribution far{Shape::normal, 1.0, 0.01};
  far.low = 3.0;
  far.high = 4.0;
  EXPECT_NEAR(quantile(far, 0.5), 3.0 + 0.01 * std::log(2.0) / 200.0, 1e-9);
  EXPECT_GT(quantile(far, 0.75), quantile(far, 0.5));
  far.low = -2.0;
  far.high = -1.0;
  EXPECT_NEAR(quantile(far, 0.5), -1.0 - 0.01 * std::log(2.0) / 200.0, 1e-9);
}

TEST(IsoFit, HasTheLimitsOfTheStandard) {
  const auto close = iso_fit("H7/g6", 0.010);
  ASSERT_TRUE(close);
  EXPECT_DOUBLE_EQ(close->hole_high, 15e-6);
  EXPECT_DOUBLE_EQ(close->shaft_low, -14e-6);
  EXPECT_DOUBLE_EQ(close->smallest_clearance(), 2.5e-6);
  EXPECT_DOUBLE_EQ(close->largest_clearance(), 14.5e-6);
  EXPECT_DOUBLE_EQ(iso_fit("H8/e8", 0.010)->smallest_clearance(), 12.5e-6);
  EXPECT_DOUBLE_EQ(iso_fit("H8/e8", 0.010)->largest_clearance(), 34.5e-6);
  for (const char* loose : {"H7/f7", "H8/f7"}) EXPECT_DOUBLE_EQ(iso_fit(loose, 0.010)->smallest_clearance(), 6.5e-6);
  EXPECT_DOUBLE_EQ(iso_fit("H7/f7", 0.010)->largest_clearance(), 21.5e-6);
  EXPECT_DOUBLE_EQ(iso_fit("H8/f7", 0.010)->largest_clearance(), 25e-6);
  EXPECT_DOUBLE_EQ(iso_fit("G6/h5", 0.010)->largest_clearance(), 10e-6);
  EXPECT_DOUBLE_EQ(iso_fit("JS7/d9", 0.0101)->hole_low, -9e-6);
  EXPECT_DOUBLE_EQ(iso_fit("D11/js5", 0.5)->hole_high, 630e-6);
}

TEST(IsoFit, KnowsNoOtherCodesAndSizes) {
  for (const char* code : {"H7/q6", "H7", "h7/g6", "H7/G6", "H4/g6", "H12/g6", "H07/g6", "H7/g", "/g6", "H7/g6 ", ""}) {
    EXPECT_FALSE(iso_fit(code, 0.010)) << code;
  }
  EXPECT_FALSE(iso_fit("H7/g6", 0.0));
  EXPECT_FALSE(iso_fit("H7/g6", 0.501));
}

}  // namespace
}  // namespace freeplay
