#include "results/spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t fewest_rows = 16, radices[] = {2, 3, 5};
constexpr double half_power_width = 1.44;  // of the Hann window, in 1/(n interval): Harris 1978, table 1

/// The largest 2^a 3^b 5^c up to `most`.
std::size_t smooth_number(std::size_t most) {
  std::size_t best = 1;
  for (std::size_t a = 1; a <= most; a *= 2) {
    for (std::size_t b = a; b <= most; b *= 3) {
      for (std::size_t c = b; c <= most; c *= 5) best = std::max(best, c);
    }
  }
  return best;
}

/// X_k = sum_i x_i e^(-2 pi j k i/n) for n = 2^a 3^b 5^c, by Cooley and Tukey, decimated in time.
class Transform {
 public:
  explicit Transform(std::size_t n) : n_(n), roots_(n) {
    for (std::size_t k = 0; k < n; ++k) {
      roots_[k] = std::polar(1.0, -2.0 * M_PI * static_cast<double>(k) / static_cast<double>(n));
    }
  }
  std::vector<Complex> of(std::span<const double> x) const {
    std::vector<Complex> out(n_);
    part(x.data(), 1, out.data(), n_);
    return out;
  }

 private:
  /// Every `stride`-th number from x on, n of them.
  void part(const double* x, std::size_t stride, Complex* out, std::size_t n) const {
    if (n == 1) {
      *out = *x;
      return;
    }
    const std::size_t radix = *std::ranges::find_if(radices, [&](std::size_t r) { return n % r == 0; }), m = n / radix;
    for (std::size_t r = 0; r < radix; ++r) part(x + r * stride, stride * radix, out + r * m, m);
    for (std::size_t k = 0; k < m; ++k) {
      Complex terms[5];
      for (std::size_t r = 0; r < radix; ++r) terms[r] = out[r * m + k] * roots_[r * k * stride];
      for (std::size_t q = 0; q < radix; ++q) {
        Complex sum = terms[0];
        for (std::size_t r = 1; r < radix; ++r) sum += terms[r] * roots_[r * q % radix * (n_ / radix)];
        out[q * m + k] = sum;
      }
    }
  }

  std::size_t n_;
  std::vector<Complex> roots_;
};

}  // namespace

Spectrum spectrum(const RowGrid& grid, std::span<const std::span<const double>> columns) {
  if (grid.rows.size() < fewest_rows) {
    throw Error(Error::Category::numerical, "too-few-rows",
                fmt::format("a spectrum wants {} rows at equal distances in the time that counts, and there are {}",
                            fewest_rows, grid.rows.size()),
                {}, "take a smaller interval, a later end or a smaller discard");
  }
  const std::size_t n = smooth_number(grid.rows.size());
  const std::span rows = std::span(grid.rows).last(n);
  const double count = static_cast<double>(n);
  std::vector<double> window(n), x(n);
  for (std::size_t i = 0; i < n; ++i) window[i] = 0.5 * (1.0 - std::cos(2.0 * M_PI * static_cast<double>(i) / count));
  const double scale = 2.0 / std::accumulate(window.begin(), window.end(), 0.0);
  Spectrum out;
  for (std::size_t k = 0; k <= n / 2; ++k) {
    out.frequency.push_back(static_cast<double>(k) / (count * grid.interval));
  }
  out.resolution = half_power_width / (count * grid.interval);
  const Transform transform(n);
  for (const std::span<const double> column : columns) {
    double mean = 0.0;
    for (const std::size_t row : rows) mean += column[row];
    mean /= count;
    for (std::size_t i = 0; i < n; ++i) x[i] = window[i] * (column[rows[i]] - mean);
    const std::vector<Complex> lines = transform.of(x);
    std::vector<double>& amplitudes = out.amplitudes.emplace_back();
    for (std::size_t k = 0; k <= n / 2; ++k) amplitudes.push_back(scale * std::abs(lines[k]));
    amplitudes.front() = std::isnan(mean) ? mean : 0.0;
  }
  return out;
}

}  // namespace freeplay
