#include "study/draws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "base/philox.h"

namespace freeplay {
namespace {

std::uint64_t fraction_of(double u) { return static_cast<std::uint64_t>(u * 0x1p52 - 0.5); }

std::vector<double> sample_of(const Draws& draws, std::uint64_t k) {
  std::vector<double> numbers(draws.axes());
  draws.fill(k, numbers);
  return numbers;
}

// The known answers of Random123 1.14, kat_vectors, philox4x64 with ten rounds.
TEST(Philox, GivesThePublishedWords) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0})[0], 0x16554d9eca36314cu);
  constexpr std::uint64_t all = ~std::uint64_t{0};
  EXPECT_EQ(philox({all, all, all, all}, {all, all})[0], 0x87b092c3013fe90bu);
  EXPECT_EQ(philox({0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89},
                   {0x452821e638d01377, 0xbe5466cf34e90c6c})[0],
            0xa528f45403e61d95u);
}

TEST(Draws, AreWordsOfPhiloxByNumber) {
  const Draws draws(SampleMethod::random, 11, 0, 2);
  for (const std::uint64_t k : {std::uint64_t{0}, std::uint64_t{399}, std::uint64_t{1} << 40}) {
    EXPECT_EQ(sample_of(draws, k)[1], unit_number(philox({k, 1, 0, 0}, {11, 0x73747564})[0]));
  }
}

// The map from seed and number to a value never changes: other versions have made tables by it.
TEST(Draws, StayWhatTheyWere) {
  EXPECT_EQ(sample_of(Draws(SampleMethod::random, 7, 0, 1), 3)[0], 0x1.1c5c62f5d8b19p-1);
  const std::vector<std::uint64_t> strata = {9, 0, 1, 7, 2, 5, 6, 8, 3, 4};
  for (std::uint64_t k = 0; k < strata.size(); ++k) EXPECT_EQ(shuffled(k, 10, 7, 0), strata[k]) << k;
  EXPECT_EQ(sample_of(Draws(SampleMethod::sobol, 7, 0, 2), 5)[1], 0x1.10f0a60a838ebp-1);
}

TEST(Draws, OfALatinHypercubeTakeEachStratumOnce) {
  for (const std::uint64_t count : {1u, 2u, 3u, 7u, 16u, 500u, 1009u}) {
    const Draws draws(SampleMethod::latin_hypercube, 11, count, 2);
    std::array<std::set<std::uint64_t>, 2> seen;
    for (std::uint64_t k = 0; k < count; ++k) {
      const std::vector<double> u = sample_of(draws, k);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        EXPECT_GT(u[axis], 0.0);
        EXPECT_LT(u[axis], 1.0);
        seen[axis].insert(static_cast<std::uint64_t>(u[axis] * static_cast<double>(count)));
      }
    }
    EXPECT_EQ(seen[0].size(), count);
    EXPECT_EQ(seen[1].size(), count);
  }
}

// Three standard errors of the correlation of independent ranks, 1/sqrt(n).
TEST(Draws, OfALatinHypercubeShuffleAxesApart) {
  constexpr std::uint64_t count = 2000;
  for (const auto& [seed, first, second] : {std::array<std::uint64_t, 3>{1, 0, 1}, {1, 2, 7}, {5, 0, 3}}) {
    double sum = 0.0, own = 0.0;
    const double middle = (count - 1) / 2.0;
    for (std::uint64_t k = 0; k < count; ++k) {
      const double a = static_cast<double>(shuffled(k, count, seed, first)) - middle;
      sum += a * (static_cast<double>(shuffled(k, count, seed, second)) - middle);
      own += a * a;
    }
    EXPECT_LT(std::abs(sum / own), 3.0 / std::sqrt(count));
  }
}

TEST(Shuffled, IsABijectionOfHugeCountsByNumber) {
  constexpr std::uint64_t count = 999'999'999'989;
  std::set<std::uint64_t> seen;
  for (std::uint64_t k = 0; k < 1000; ++k) {
    const std::uint64_t place = shuffled(count - 1 - k, count, 3, 0);
    EXPECT_LT(place, count);
    seen.insert(place);
  }
  EXPECT_EQ(seen.size(), 1000u);
}

// Joe and Kuo's numbers, as their program prints them for new-joe-kuo-6.21201; the shift is that of element zero.
TEST(Draws, OfSobolAreThePublishedNumbersShifted) {
  const double published[10][3] = {{0, 0, 0},
                                   {0.5, 0.5, 0.5},
                                   {0.75, 0.25, 0.25},
                                   {0.25, 0.75, 0.75},
                                   {0.375, 0.375, 0.625},
                                   {0.875, 0.875, 0.125},
                                   {0.625, 0.125, 0.875},
                                   {0.125, 0.625, 0.375},
                                   {0.1875, 0.3125, 0.9375},
                                   {0.6875, 0.8125, 0.4375}};
  const Draws draws(SampleMethod::sobol, 42, 0, 3);
  const std::vector<double> shift = sample_of(draws, 0);
  for (const std::uint64_t k : {9u, 0u, 4u, 1u, 8u, 2u, 3u, 7u, 5u, 6u}) {
    const std::vector<double> u = sample_of(draws, k);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(static_cast<double>(fraction_of(u[axis]) ^ fraction_of(shift[axis])) * 0x1p-52, published[k][axis])
          << k << " " << axis;
    }
  }
  for (std::uint64_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(fraction_of(shift[axis]), philox({std::uint64_t{1} << 63, axis, 0, 0}, {42, 0x73747564})[0] >> 12);
  }
}

TEST(Draws, OfSobolMeetEveryElementaryInterval) {
  const Draws draws(SampleMethod::sobol, 11, 0, 2);
  for (int a = 0; a <= 8; ++a) {
    std::set<std::pair<int, int>> cells;
    for (std::uint64_t k = 0; k < 256; ++k) {
      const std::vector<double> u = sample_of(draws, k);
      cells.emplace(static_cast<int>(u[0] * (1 << a)), static_cast<int>(u[1] * (1 << (8 - a))));
    }
    EXPECT_EQ(cells.size(), 256u) << a;
  }
}

}  // namespace
}  // namespace freeplay
