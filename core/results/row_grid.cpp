#include "results/row_grid.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

constexpr double same_instant_of_grid = 1e-9;  // of the interval

// The median of the steps: rows inside of impacts and at the end lie closer together.
double usual_interval(std::span<const double> time) {
  if (time.size() < 2) return 0.0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

}  // namespace

RowGrid RowGrid::of(std::span<const double> time, double origin, double from, double interval) {
  RowGrid grid;
  grid.interval = interval > 0.0 ? interval : usual_interval(time);
  if (!(grid.interval > 0.0)) return grid;
  double last = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double place = (time[i] - origin) / grid.interval, number = std::round(place);
    // An instant has the rounding of its own size, too.
    const double rounding = 4e-16 * std::abs(time[i]) / grid.interval;
    if (!(std::abs(place - number) <= same_instant_of_grid + rounding)) continue;
    if (time[i] < from - same_instant_of_grid * grid.interval) continue;
    if (!grid.rows.empty() && number != last + 1.0) grid.rows.clear();
    grid.rows.push_back(i);
    last = number;
  }
  return grid;
}

}  // namespace freeplay
