#include "results/figure_text.h"

#include <limits>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(FigureText, HasFourDigitsWhereNothingSpeaksAgainstThem) {
  EXPECT_EQ("51.13 N", figure_text(51.1297, "N"));
  EXPECT_EQ("1.293e+04 N", figure_text(12934.0, "N"));
  EXPECT_EQ("7e-07 m", figure_text(7.04e-7, "m", 0.0, {.digits = 2}));
  EXPECT_EQ("306.4 um", figure_text(3.0641e-4, "m", 0.0, {.prefixed = true}));
  EXPECT_EQ("0 N", figure_text(0.0, "N"));
  EXPECT_EQ("-", figure_text(std::numeric_limits<double>::quiet_NaN(), "N"));
}

TEST(FigureText, HasNoMoreDigitsThanTheNoiseLeaves) {
  EXPECT_EQ("51.1 N", figure_text(51.1297, "N", 0.1));
  EXPECT_EQ("51.13 N", figure_text(51.1297, "N", 0.001));
  EXPECT_EQ("13 +- 3 kN", figure_text(12934.0, "N", 2600.0));
  EXPECT_EQ("12.9 +- 0.4 kN", figure_text(12934.0, "N", 390.0));
  EXPECT_EQ("50 +- 20 N", figure_text(51.13, "N", 17.0));
  EXPECT_EQ("51 +- 14 N", figure_text(51.13, "N", 14.0));
  EXPECT_EQ("700 +- 200 nm", figure_text(7.04e-7, "m", 2.1e-7, {.digits = 2}));
  EXPECT_EQ("200 +- 200 N", figure_text(230.0, "N", 170.0));
  EXPECT_EQ("5e-20 +- 1e-20 N", figure_text(4.8e-20, "N", 1e-20));
}

TEST(FigureText, CountsAndPartsHaveTheirNoise) {
  EXPECT_EQ("162", count_text(162, 0.0));
  EXPECT_EQ("160 +- 30", count_text(162, 26.0));
  EXPECT_EQ("30 +- 10", count_text(29, 10.8));
  EXPECT_EQ("0 +- 5", count_text(0, 5.2));
  EXPECT_EQ("71.7 %", share_text(0.7168, 0.0));
  EXPECT_EQ("72 +- 6 %", share_text(0.7168, 0.06));
  EXPECT_EQ("99.6 +- 0.2 %", share_text(0.9962, 0.002));
}

Json spread(double median, double low, double high) {
  return {{"median", median}, {"min", low}, {"max", high}, {"values", {low, median, high, nullptr}}};
}

TEST(FigureText, ARangeHasTheDigitsThatItLeaves) {
  EXPECT_EQ("12.9 kN (12.0 to 15.6 in 3 runs)", range_text(spread(12930.0, 12040.0, 15580.0), "N"));
  EXPECT_EQ("51.13 N (51.12 to 51.14 in 3 runs)", range_text(spread(51.13, 51.12, 51.14), "N"));
  EXPECT_EQ("61 (15 to 87 in 3 runs)", range_text(spread(61.0, 15.0, 87.0), ""));
  EXPECT_EQ("-", range_text(Json::parse(R"({"median": null, "min": null, "max": null, "values": []})"), "N"));
}

}  // namespace
}  // namespace freeplay
