#include "results/spectrum.h"

#include <cmath>
#include <complex>
#include <limits>

#include <gtest/gtest.h>

#include "base/error.h"

namespace freeplay {
namespace {

RowGrid spectrum_grid(std::size_t rows, double interval) {
  RowGrid grid{.interval = interval, .rows = {}};
  for (std::size_t i = 0; i < rows; ++i) grid.rows.push_back(i);
  return grid;
}

Spectrum of(const RowGrid& grid, const std::vector<double>& x) {
  const std::span<const double> column(x);
  return spectrum(grid, {&column, 1});
}

TEST(Spectrum, OfASineOnALineIsItsAmplitudeThere) {
  const std::size_t n = 120;
  std::vector<double> x;
  for (std::size_t i = 0; i < n; ++i)
    x.push_back(5.0 + 3.0 * std::sin(2.0 * M_PI * 12.0 * static_cast<double>(i) / 120.0));
  const Spectrum s = of(spectrum_grid(n, 1e-3), x);
  ASSERT_EQ(s.frequency.size(), 61u);
  EXPECT_NEAR(s.frequency[12], 100.0, 1e-12);
  const std::vector<double>& a = s.amplitudes[0];
  EXPECT_NEAR(a[12], 3.0, 1e-13);
  EXPECT_NEAR(a[11], 1.5, 1e-13);  // the window's neighbours
  EXPECT_NEAR(a[13], 1.5, 1e-13);
  EXPECT_EQ(a[0], 0.0);
  for (std::size_t k = 1; k < a.size(); ++k) {
    if (k >= 11 && k <= 13) continue;
    EXPECT_NEAR(a[k], 0.0, 1e-13) << k;
  }
  EXPECT_NEAR(s.resolution, 1.44 / 0.12, 1e-12);
}

TEST(Spectrum, IsTheSumThatDefinesItForEverySmoothNumberOfRows) {
  for (const std::size_t n : {16u, 18u, 20u, 25u, 27u, 30u, 45u, 60u, 64u, 75u, 81u, 90u, 125u, 180u}) {
    std::vector<double> x;
    for (std::size_t i = 0; i < n; ++i)
      x.push_back(std::cos(0.7 * static_cast<double>(i * i)) + 0.01 * static_cast<double>(i));
    const Spectrum s = of(spectrum_grid(n, 0.5), x);
    ASSERT_EQ(s.amplitudes[0].size(), n / 2 + 1);
    double mean = 0.0, weights = 0.0;
    for (const double value : x) mean += value / static_cast<double>(n);
    for (std::size_t k = 1; k <= n / 2; ++k) {
      std::complex<double> sum = 0.0;
      weights = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        const double turn = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(n);
        const double w = 0.5 * (1.0 - std::cos(turn));
        weights += w;
        sum += w * (x[i] - mean) * std::polar(1.0, -turn * static_cast<double>(k));
      }
      EXPECT_NEAR(s.amplitudes[0][k], 2.0 / weights * std::abs(sum), 1e-13) << n << " " << k;
    }
  }
}

TEST(Spectrum, TakesTheLastRowsOfASmoothNumber) {
  std::vector<double> x(19, 0.0);
  x[0] = 1e9;  // 18 rows are taken
  EXPECT_NEAR(of(spectrum_grid(19, 1.0), x).amplitudes[0][1], 0.0, 0.0);
  EXPECT_EQ(of(spectrum_grid(19, 1.0), x).frequency.size(), 10u);
}

TEST(Spectrum, OfAChannelWithoutANumberIsNone) {
  std::vector<double> x(16, 1.0);
  x[3] = std::numeric_limits<double>::quiet_NaN();
  const Spectrum s = of(spectrum_grid(16, 1.0), x);
  for (const double a : s.amplitudes[0]) EXPECT_TRUE(std::isnan(a));
}

TEST(Spectrum, RefusesTooFewRows) {
  try {
    of(spectrum_grid(15, 1.0), std::vector<double>(15, 1.0));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 4);
    EXPECT_EQ(error.id(), "too-few-rows");
  }
}

}  // namespace
}  // namespace freeplay
