// Reducer: one number, or some, out of a run.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace freeplay {

/// What is made of values over time or over a list.
enum class Reduction {
  min,
  max,
  absmax,
  first,
  final,
  peak_to_peak,
  mean,
  rms,
  std_deviation,
  percentile,
  time_fraction,
  count,
};

struct ReductionRule {
  Reduction kind = Reduction::final;
  double p = 50.0;     ///< of percentile
  double bound = 0.0;  ///< of time_fraction and count
  bool above = true;   ///< of the bound, or passed upwards
};

/// Takes values with weights one after the other and gives one number of them. Its memory grows with them for
/// percentiles alone.
class Reduced {
 public:
  explicit Reduced(const ReductionRule& rule) : rule_(rule) {}

  /// A value at an instant, weighed by the trapezoidal rule: half of the time to each neighbour.
  void add_at(double time, double value);
  /// A value that weighs as much as each other.
  void add(double value);
  /// NaN where there is none. Nothing may be added any more.
  double result();
  void clear();

 private:
  void weigh(double value, double weight);

  ReductionRule rule_;
  bool any_ = false, failed_ = false;
  double first_ = 0.0, last_ = 0.0, last_time_ = 0.0, half_before_ = 0.0;
  bool waiting_ = false;  ///< the last value has the half of the time before it only
  double low_ = 0.0, high_ = 0.0;
  double weight_ = 0.0, mean_ = 0.0, spread_ = 0.0, square_ = 0.0, beyond_ = 0.0;
  double passages_ = 0.0;
  std::vector<std::pair<double, double>> values_{};  // and weights, of percentile
};

}  // namespace freeplay
