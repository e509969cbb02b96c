// StopRule: sampling ends where the interval of an estimate is narrow enough.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace freeplay {

struct StopOptions {
  std::string reducer;
  double percentile = -1.0;  ///< < 0: of the mean
  double confidence = 0.95;
  std::optional<double> half_width, relative;  ///< one of them
  std::uint64_t min_points = 200, block = 100;
};

struct StopInterval {
  double estimate = 0.0, half_width = 0.0;
};

/// Values of every combination, by sample; whatever comes in between, the end depends on the values alone.
class StopRule {
 public:
  StopRule(StopOptions options, std::uint64_t combinations, std::uint64_t samples);

  const StopOptions& options() const { return options_; }
  /// NaN: the point has none.
  void note(std::uint64_t combination, std::uint64_t sample, double value);

  /// Samples after which it ends, once they are there: of so many, all that were planned if no interval is narrow
  /// enough.
  std::optional<std::uint64_t> end() const { return end_; }
  /// Were all intervals narrow enough at the end or at the last look?
  bool reached() const { return reached_; }
  /// Of each combination, over the samples up to the end or to the last look.
  const std::vector<StopInterval>& intervals() const { return intervals_; }
  std::uint64_t looked_at() const { return looked_at_; }

 private:
  void look();
  bool complete(std::uint64_t count);
  StopInterval interval(std::vector<double> values) const;

  StopOptions options_;
  std::uint64_t samples_, next_look_, looked_at_ = 0;
  std::vector<std::vector<double>> values_;
  std::vector<std::vector<bool>> there_;
  std::vector<std::uint64_t> first_missing_;
  std::optional<std::uint64_t> end_;
  bool reached_ = false;
  std::vector<StopInterval> intervals_;
};

}  // namespace freeplay
