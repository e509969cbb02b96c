#include "results/poincare_section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace freeplay {
namespace {

constexpr double reached_to = 1e-9;  // of the step between the last rows

/// How far the parabola through rows i - 1, i, i + 1 lies from their chord in the middle of i and i + 1, or more.
double bulge(std::span<const double> t, std::span<const double> x, std::size_t i) {
  const double before = t[i] - t[i - 1], step = t[i + 1] - t[i];
  const double bend = ((x[i + 1] - x[i]) / step - (x[i] - x[i - 1]) / before) / (before + step);
  const double longest = std::max(before, step);
  return 0.25 * std::abs(bend) * longest * longest;
}

double bulge_around(std::span<const double> t, std::span<const double> x, std::size_t i) {
  double most = 0.0;
  if (i > 0) most = std::max(most, bulge(t, x, i));
  if (i + 2 < t.size()) most = std::max(most, bulge(t, x, i + 1));
  return most;
}

}  // namespace

PoincareSection poincare_section(std::span<const double> time, std::span<const std::span<const double>> columns,
                                 double phase, double period) {
  PoincareSection out;
  out.values.resize(columns.size());
  out.uncertainty.assign(columns.size(), time.size() < 3 ? std::numeric_limits<double>::quiet_NaN() : 0.0);
  if (time.size() < 2) return out;
  const double rounding = reached_to * (time.back() - time[time.size() - 2]);
  const double first = std::max(0.0, std::ceil((time.front() - rounding - phase) / period));
  std::size_t row = 0;
  for (double k = first; phase + k * period <= time.back() + rounding; k += 1.0) {
    const double t = phase + k * period;
    while (row + 2 < time.size() && time[row + 1] <= t) ++row;
    const double s = std::clamp((t - time[row]) / (time[row + 1] - time[row]), 0.0, 1.0);
    out.time.push_back(t);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::span<const double> x = columns[c];
      // A row that is met is taken as it is: its neighbour may hold no number.
      out.values[c].push_back(s == 0.0 ? x[row] : s == 1.0 ? x[row + 1] : (1.0 - s) * x[row] + s * x[row + 1]);
      if (time.size() > 2) out.uncertainty[c] = std::max(out.uncertainty[c], bulge_around(time, x, row));
    }
  }
  return out;
}

}  // namespace freeplay
