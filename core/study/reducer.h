// Reduced: one number out of many.
#pragma once

#include <limits>
#include <utility>
#include <vector>

namespace freeplay {

enum class Reduction {
  min,
  max,
  absmax,
  first,
  final,
  peak_to_peak,
  mean,
  rms,
  standard_deviation,
  percentile,
  time_fraction,
  count,
};

/// Else it is a number without one.
inline bool has_unit_of_values(Reduction kind) { return kind != Reduction::count && kind != Reduction::time_fraction; }

struct ReductionRule {
  Reduction kind = Reduction::final;
  double p = 50.0;     ///< of percentile
  double bound = 0.0;  ///< of time_fraction and count
  bool above = true;   ///< of the bound, or passed upwards; else below and downwards
};

/// A sum that does not lose what is small beside it (Neumaier).
class ExactSum {
 public:
  void add(double value);
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0.0, rest_ = 0.0;
};

/// Takes values one after the other and gives one number of them. Its memory grows with them for percentiles alone.
class Reduced {
 public:
  explicit Reduced(const ReductionRule& rule) : rule_(rule) {}

  /// A value at an instant, weighed by the trapezoidal rule: half of the time to each neighbour.
  void add_at(double time, double value);
  /// A value inside of a step, which may be an extreme and counts for nothing else.
  void add_inside(double value);
  /// A value that weighs as much as each other; a count is then the number of them.
  void add(double value);
  /// NaN where there is none, as where a value was none. Nothing may be added any more.
  double result();

 private:
  bool see(double value);
  void weigh(double value, double weight);
  double percentile();

  ReductionRule rule_;
  bool any_ = false, failed_ = false;
  double first_ = 0.0, last_ = 0.0, last_time_ = 0.0;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
  double half_before_ = -1.0;  // of the last value, whose time to the next is not known yet; -1: there is none
  ExactSum weight_, sum_, squares_, beyond_;
  double weight_so_far_ = 0.0, mean_ = 0.0, spread_ = 0.0;  // West's recurrence for the deviation
  double count_ = 0.0;
  std::vector<std::pair<double, double>> values_{};  // and weights
};

}  // namespace freeplay
