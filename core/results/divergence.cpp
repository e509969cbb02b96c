#include "results/divergence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {
namespace {

constexpr std::size_t most_points = 5000, blocks = 8;
constexpr double no_slope = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void too_few(const std::string& why) {
  throw Error(Error::Category::numerical, "too-few-rows", "an exponent cannot be estimated: " + why, {},
              "take a later end, a smaller interval or another --period");
}

/// Points by their numbers, one after the other.
struct Cloud {
  std::size_t width = 0, count = 0;
  std::vector<double> numbers;

  double distance_squared(std::size_t i, std::size_t j) const {
    const double *a = numbers.data() + i * width, *b = numbers.data() + j * width;
    double sum = 0.0;
    for (std::size_t c = 0; c < width; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
  }
};

Cloud cloud_of(const std::vector<std::size_t>& rows, std::span<const std::span<const double>> columns) {
  Cloud cloud;
  cloud.count = rows.size();
  std::vector<std::vector<double>> scaled;
  for (const std::span<const double> column : columns) {
    const double n = static_cast<double>(rows.size());
    double mean = 0.0, square = 0.0;
    for (const std::size_t row : rows) mean += column[row];
    mean /= n;
    for (const std::size_t row : rows) square += (column[row] - mean) * (column[row] - mean);
    const double deviation = std::sqrt(square / n);
    if (!(deviation > 1e-14 * std::abs(mean)) || !std::isfinite(deviation)) continue;
    std::vector<double>& numbers = scaled.emplace_back();
    for (const std::size_t row : rows) numbers.push_back(column[row] / deviation);
  }
  cloud.width = scaled.size();
  cloud.numbers.reserve(cloud.width * cloud.count);
  for (std::size_t i = 0; i < cloud.count; ++i) {
    for (const std::vector<double>& numbers : scaled) cloud.numbers.push_back(numbers[i]);
  }
  return cloud;
}

std::optional<std::size_t> neighbour(const Cloud& cloud, std::size_t i, std::size_t end, double step, double period) {
  std::optional<std::size_t> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < end; ++j) {
    if (!(static_cast<double>(i > j ? i - j : j - i) * step > period)) continue;
    const double distance = cloud.distance_squared(i, j);
    if (distance < nearest) nearest = distance, best = j;
  }
  return best;
}

/// Sums of logarithms by k.
struct Sums {
  std::vector<double> sum, count;

  explicit Sums(std::size_t size) : sum(size, 0.0), count(size, 0.0) {}
  void add(const Sums& other) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += other.sum[k], count[k] += other.count[k];
  }
  double mean(std::size_t k) const { return count[k] > 0.0 ? sum[k] / count[k] : no_slope; }
  /// Of the line of least squares through what there is, over k.
  double slope() const { return slope(0, sum.size() - 1); }
  /// The same from one k to another.
  double slope(std::size_t from, std::size_t to) const {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t k = from; k <= to; ++k) {
      if (count[k] > 0.0) n += 1.0, x += static_cast<double>(k), y += mean(k);
    }
    for (std::size_t k = from; k <= to; ++k) {
      if (!(count[k] > 0.0)) continue;
      const double from_middle = static_cast<double>(k) - x / n;
      xx += from_middle * from_middle;
      xy += from_middle * (mean(k) - y / n);
    }
    return n > 1.0 ? xy / xx : no_slope;
  }
};

/// How far the course of the logarithms is from a straight line: the largest difference between its slope and that of
/// beginnings, halved again and again; distances that reach the size of the motion grow no more. The first step is left
/// out of them, in which neighbours turn towards where they go apart. NaN where there is no second one.
double bend(const Sums& all) {
  const std::size_t last = all.sum.size() - 1;
  double most = no_slope;
  for (std::size_t steps = last - 1; steps > 0; steps /= 2) {
    most = std::fmax(most, std::abs(all.slope(1, 1 + steps) - all.slope()));
  }
  return most;
}

double standard_error(const std::vector<double>& slopes) {
  const double n = static_cast<double>(slopes.size());
  if (n < 2.0) return no_slope;
  double mean = 0.0, square = 0.0;
  for (const double slope : slopes) mean += slope / n;
  for (const double slope : slopes) square += (slope - mean) * (slope - mean);
  return std::sqrt(square / (n - 1.0) / n);
}

}  // namespace

Divergence divergence(const RowGrid& grid, std::span<const std::span<const double>> columns, double period) {
  const std::size_t stride = std::max<std::size_t>(1, (grid.rows.size() + most_points - 1) / most_points);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < grid.rows.size(); i += stride) rows.push_back(grid.rows[i]);
  const double step = static_cast<double>(stride) * grid.interval, steps = std::round(period / step);
  if (!(steps >= 1.0)) too_few(fmt::format("a period of {:g} s is shorter than {:g} s between points", period, step));
  if (!(2.0 * steps < static_cast<double>(rows.size()))) {
    too_few(fmt::format("the time that counts is shorter than two periods of {:g} s", period));
  }
  const auto last = static_cast<std::size_t>(steps);
  const Cloud cloud = cloud_of(rows, columns);
  if (cloud.width == 0) too_few("no channel changes");
  const std::size_t end = cloud.count - last;
  std::vector<Sums> parts(blocks, Sums(last + 1));
  Divergence out;
  for (std::size_t i = 0; i < end; ++i) {
    const auto j = neighbour(cloud, i, end, step, period);
    if (!j) continue;
    ++out.points;
    Sums& part = parts[i * blocks / end];
    for (std::size_t k = 0; k <= last; ++k) {
      const double distance = cloud.distance_squared(i + k, *j + k);
      if (distance > 0.0) part.sum[k] += 0.5 * std::log(distance), part.count[k] += 1.0;
    }
  }
  Sums all(last + 1);
  std::vector<double> slopes;
  for (const Sums& part : parts) {
    all.add(part);
    if (const double slope = part.slope(); !std::isnan(slope)) slopes.push_back(slope / step);
  }
  out.exponent = all.slope() / step;
  if (std::isnan(out.exponent)) too_few("no two parts of the motion are near and apart");
  out.uncertainty = std::hypot(standard_error(slopes), bend(all) / step);
  for (std::size_t k = 0; k <= last; ++k) {
    out.time.push_back(static_cast<double>(k) * step);
    out.logarithm.push_back(all.mean(k));
  }
  return out;
}

}  // namespace freeplay
