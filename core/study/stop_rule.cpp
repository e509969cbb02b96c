#include "study/stop_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "study/normal_quantile.h"
#include "study/percentile_ranks.h"

namespace freeplay {

StopRule::StopRule(StopOptions options, std::uint64_t combinations, std::uint64_t samples)
    : options_(std::move(options)),
      samples_(samples),
      next_look_(std::min(options_.min_points, samples)),
      values_(combinations),
      there_(combinations),
      first_missing_(combinations, 0) {}

void StopRule::note(std::uint64_t combination, std::uint64_t sample, double value) {
  auto& values = values_[combination];
  auto& there = there_[combination];
  if (sample >= values.size()) {
    values.resize(sample + 1);
    there.resize(sample + 1);
  }
  values[sample] = value;
  there[sample] = true;
  std::uint64_t& missing = first_missing_[combination];
  if (sample != missing) return;
  while (missing < there.size() && there[missing]) ++missing;
  if (missing >= next_look_) look();
}

bool StopRule::complete(std::uint64_t count) {
  return std::ranges::all_of(first_missing_, [&](std::uint64_t missing) { return missing >= count; });
}

void StopRule::look() {
  while (!end_ && complete(next_look_)) {
    looked_at_ = next_look_;
    intervals_.clear();
    bool narrow = true;
    for (const std::vector<double>& values : values_) {
      std::vector<double> some(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(looked_at_));
      intervals_.push_back(interval(std::move(some)));
      const StopInterval& last = intervals_.back();
      const double limit =
          options_.half_width ? *options_.half_width : options_.relative.value_or(0.0) * std::abs(last.estimate);
      narrow = narrow && last.half_width <= limit;
    }
    reached_ = narrow;
    if (narrow || looked_at_ == samples_) end_ = looked_at_;
    next_look_ = std::min(next_look_ + options_.block, samples_);
  }
}

/// The mean by the normal law, a percentile by the order of the values: its ranks are binomial.
StopInterval StopRule::interval(std::vector<double> values) const {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  const auto n = static_cast<double>(values.size());
  constexpr double none = std::numeric_limits<double>::infinity();
  if (values.size() < 2) return {std::numeric_limits<double>::quiet_NaN(), none};
  if (options_.percentile < 0.0) {
    const double z = normal_quantile(0.5 + 0.5 * options_.confidence);
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double square = 0.0;
    for (const double value : values) square += (value - mean) * (value - mean);
    return {mean, z * std::sqrt(square / (n - 1.0)) / std::sqrt(n)};
  }
  std::ranges::sort(values);
  const double p = options_.percentile / 100.0;
  const double estimate = values[static_cast<std::size_t>(std::clamp(std::ceil(n * p), 1.0, n)) - 1];
  const auto ranks = percentile_ranks(values.size(), p, options_.confidence);
  if (!ranks) return {estimate, none};
  return {estimate, 0.5 * (values[ranks->second - 1] - values[ranks->first - 1])};
}

}  // namespace freeplay
