#include "format/doubtful_points.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace freeplay {
namespace {

constexpr int places_in_piece = 8;
constexpr double beyond_all = 0.25;  // by the range of the points: eight points a turn follow a sine to a fifth

/// Do the values go on in one direction, or stay, in piece i and in those before and after it? Those of a closed curve
/// come round.
bool goes_on(std::span<const double> values, std::size_t i) {
  const bool closed = values.front() == values.back();
  const std::size_t last = values.size() - 1;
  const std::size_t before = i > 1 ? i - 1 : closed ? last : i, after = i < last ? i + 1 : closed ? 1 : i;
  const auto [least, most] =
      std::minmax({values[before] - values[before - 1], values[i] - values[i - 1], values[after] - values[after - 1]});
  return least >= 0.0 || most <= 0.0;
}

}  // namespace

void doubt_overshoot(const TimeTable& table, const CheckedValue& written, const PointWords& words) {
  const std::span<const double> places = table.times(), values = table.values();
  const auto all = std::ranges::minmax(values);
  const double range = all.max - all.min;
  if (table.is_straight() || !(range > 0.0)) return;
  double excess = 1.0, reached = 0.0, where = 0.0;
  std::pair<double, double> between;
  bool at_two = false;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const bool two = words.along < unbounded && goes_on(values, i);
    const std::pair<double, double> bounds =
        two ? std::minmax({values[i - 1], values[i]}) : std::pair(all.min, all.max);
    for (int k = 1; k < places_in_piece; ++k) {
      const double place = places[i - 1] + (places[i] - places[i - 1]) * k / places_in_piece;
      Jet jet;
      EvaluationFailure failure;
      if (!table.evaluate(place, jet, failure)) return;
      const double beyond = std::max(jet.value - bounds.second, bounds.first - jet.value);
      if (!(beyond > excess * (two ? words.along : beyond_all) * range)) continue;
      excess = beyond / ((two ? words.along : beyond_all) * range), reached = jet.value, where = place;
      between = bounds, at_two = two;
    }
  }
  if (!(excess > 1.0)) return;
  written.warn("doubtful-value",
               fmt::format("the cubic through the points of '{}' comes to {:.4g}{} at {} = {:.4g}{}, but {} {:.4g} and "
                           "{:.4g}: {}give more points",
                           written.path(), reached, words.unit, words.variable, where, words.variable_unit,
                           at_two ? "the two points beside it are" : "its points lie between", between.first,
                           between.second, words.may_be_straight ? "write 'interpolation: linear', or " : ""));
}

}  // namespace freeplay
