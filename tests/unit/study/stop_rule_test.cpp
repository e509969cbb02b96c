#include "study/stop_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "study/normal_quantile.h"
#include "study/percentile_ranks.h"

namespace freeplay {
namespace {

// Digits of published tables.
TEST(NormalQuantile, HasPublishedDigits) {
  EXPECT_NEAR(1.959963984540054, normal_quantile(0.975), 1e-15);
  EXPECT_NEAR(0.6744897501960817, normal_quantile(0.75), 1e-15);
  EXPECT_NEAR(-3.090232306167814, normal_quantile(0.001), 5e-15);
  EXPECT_NEAR(-9.262340089798408, normal_quantile(1e-20), 1e-14);
  EXPECT_EQ(0.0, normal_quantile(0.5));
}

StopOptions options(double half_width) {
  StopOptions result;
  result.half_width = half_width;
  result.min_points = 4;
  result.block = 2;
  return result;
}

TEST(StopRule, EndsAtTheFirstLookThatIsNarrowEnough) {
  const std::vector<double> values{0.0, 4.0, 0.0, 4.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0};
  // Sum of squares about the mean 2 is 16: s/sqrt(n) is sqrt(16/3/4), sqrt(16/5/6) and sqrt(16/7/8).
  const double z = normal_quantile(0.975), after_6 = z * std::sqrt(16.0 / 5.0 / 6.0);
  StopRule rule(options(after_6 * (1.0 + 1e-12)), 1, values.size());
  for (std::size_t k = 0; k < values.size(); ++k) rule.note(0, k, values[k]);
  EXPECT_EQ(6u, rule.end());
  EXPECT_NEAR(after_6, rule.intervals().at(0).half_width, 1e-15);
  EXPECT_EQ(2.0, rule.intervals()[0].estimate);
}

TEST(StopRule, SaysWhetherItEndedForLackOfSamples) {
  StopRule narrow(options(1e-9), 1, 6), wide(options(100.0), 1, 6);
  for (std::uint64_t k = 0; k < 6; ++k) {
    narrow.note(0, k, static_cast<double>(k));
    wide.note(0, k, static_cast<double>(k));
  }
  EXPECT_EQ(6u, narrow.end());
  EXPECT_FALSE(narrow.reached());
  EXPECT_EQ(4u, wide.end());
  EXPECT_TRUE(wide.reached());
}

TEST(StopRule, OrderOfArrivalChangesNothing) {
  std::mt19937 random(1);
  std::vector<double> values(200);
  for (double& value : values) value = std::generate_canonical<double, 53>(random);
  std::vector<std::size_t> order(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  StopRule reference(options(0.06), 1, values.size());
  for (const std::size_t k : order) reference.note(0, k, values[k]);
  ASSERT_TRUE(reference.end());
  ASSERT_LT(*reference.end(), values.size());
  for (int turn = 0; turn < 5; ++turn) {
    std::shuffle(order.begin(), order.end(), random);
    StopRule rule(options(0.06), 1, values.size());
    for (const std::size_t k : order) rule.note(0, k, values[k]);
    EXPECT_EQ(reference.end(), rule.end());
  }
}

TEST(StopRule, WaitsForEveryCombinationAndSkipsWhatFailed) {
  StopRule rule(options(10.0), 2, 100);
  for (std::uint64_t k = 0; k < 10; ++k) rule.note(0, k, static_cast<double>(k));
  EXPECT_FALSE(rule.end());
  for (std::uint64_t k = 0; k < 4; ++k) rule.note(1, k, k == 2 ? std::numeric_limits<double>::quiet_NaN() : 1.0);
  EXPECT_EQ(4u, rule.end());
  EXPECT_EQ(1.0, rule.intervals().at(1).estimate);
}

TEST(StopRule, EndsWithTheSamplesAtTheLatest) {
  StopRule rule(options(1e-9), 1, 11);
  for (std::uint64_t k = 0; k < 11; ++k) rule.note(0, k, static_cast<double>(k % 2));
  EXPECT_EQ(11u, rule.end());
}

/// How often a share lies between values of these ranks, by factorials.
double coverage(int n, double share, int low, int high) {
  double sum = 0.0;
  for (int k = low; k < high; ++k) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(share) +
                    (n - k) * std::log1p(-share));
  }
  return sum;
}

TEST(StopRule, RanksOfPercentilesAreTheNarrowestOfTwoEqualTails) {
  const auto ranks = [](std::uint64_t n, double share, double confidence) {
    return percentile_ranks(n, share, confidence).value_or(std::pair<std::uint64_t, std::uint64_t>(0, 0));
  };
  EXPECT_EQ(std::pair(std::uint64_t{40}, std::uint64_t{61}), ranks(100, 0.5, 0.95));  // David and Nagaraja, 7.1
  EXPECT_EQ(std::pair(std::uint64_t{2}, std::uint64_t{9}), ranks(10, 0.5, 0.95));
  EXPECT_FALSE(percentile_ranks(367, 0.99, 0.95));  // 0.99^n <= 0.025 from 368 on
  EXPECT_TRUE(percentile_ranks(368, 0.99, 0.95));
  EXPECT_FALSE(percentile_ranks(5, 0.5, 0.95));
  for (const int n : {40, 76, 200, 1000, 20000}) {
    for (const double share : {0.05, 0.5, 0.9, 0.99}) {
      for (const double confidence : {0.5, 0.9, 0.95}) {
        const double tail = 0.5 * (1.0 - confidence);
        const auto found = percentile_ranks(static_cast<std::uint64_t>(n), share, confidence);
        if (!found) {
          EXPECT_TRUE(std::pow(share, n) > tail || std::pow(1.0 - share, n) > tail) << n << ' ' << share;
          continue;
        }
        const int low = static_cast<int>(found->first), high = static_cast<int>(found->second);
        EXPECT_LE(coverage(n, share, 0, low), tail);
        EXPECT_GT(coverage(n, share, 0, low + 1), tail) << n << ' ' << share << ' ' << confidence;
        EXPECT_LE(coverage(n, share, high, n + 1), tail);
        EXPECT_GT(coverage(n, share, high - 1, n + 1), tail) << n << ' ' << share << ' ' << confidence;
      }
    }
  }
}

TEST(StopRule, PercentileIsBoundedByRanks) {
  StopOptions of_median = options(std::numeric_limits<double>::infinity());
  of_median.percentile = 50.0;
  of_median.min_points = 100;
  StopRule rule(of_median, 1, 100);
  for (std::uint64_t k = 0; k < 100; ++k) rule.note(0, 99 - k, static_cast<double>(k + 1));
  // Ranks 40 and 61.
  EXPECT_EQ(100u, rule.end());
  EXPECT_EQ(50.0, rule.intervals().at(0).estimate);
  EXPECT_EQ(10.5, rule.intervals()[0].half_width);
}

}  // namespace
}  // namespace freeplay
