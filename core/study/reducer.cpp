#include "study/reducer.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double part_by_rounding = 1e-12;  // of all weight, that sums of weights may lack
}  // namespace

void ExactSum::add(double value) {
  const double sum = sum_ + value;
  rest_ += std::abs(sum_) >= std::abs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
  sum_ = sum;
}

// False for what is no number.
bool Reduced::see(double value) {
  if (!std::isfinite(value)) {
    failed_ = true;
    return false;
  }
  if (!any_) first_ = value;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
  return true;
}

void Reduced::add_at(double time, double value) {
  if (failed_ || !see(value)) return;
  double half = 0.0;
  if (any_) {
    half = 0.5 * (time - last_time_);
    weigh(last_, half_before_ + half);
    const bool passed =
        rule_.above ? last_ <= rule_.bound && value > rule_.bound : last_ >= rule_.bound && value < rule_.bound;
    if (passed) ++count_;
  }
  half_before_ = half;
  last_ = value;
  last_time_ = time;
  any_ = true;
}

void Reduced::add_inside(double value) {
  if (!std::isfinite(value)) return;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
}

void Reduced::add(double value) {
  if (failed_ || !see(value)) return;
  weigh(value, 1.0);
  ++count_;
  last_ = value;
  any_ = true;
}

void Reduced::weigh(double value, double weight) {
  switch (rule_.kind) {
    case Reduction::percentile:
      values_.emplace_back(value, weight);
      break;
    case Reduction::time_fraction:
      if (rule_.above ? value > rule_.bound : value < rule_.bound) beyond_.add(weight);
      break;
    case Reduction::mean:
      sum_.add(weight * value);
      break;
    case Reduction::rms:
      squares_.add(weight * value * value);
      break;
    case Reduction::standard_deviation: {
      if (!(weight > 0.0)) break;
      weight_so_far_ += weight;
      const double off = value - mean_;
      mean_ += off * (weight / weight_so_far_);
      spread_ += weight * off * (value - mean_);
      break;
    }
    default:
      return;
  }
  weight_.add(weight);
}

double Reduced::percentile() {
  std::ranges::sort(values_);
  const double wanted = (0.01 * rule_.p - part_by_rounding) * weight_.value();
  ExactSum seen;
  for (const auto& [value, weight] : values_) {
    seen.add(weight);
    if (seen.value() >= wanted) return value;
  }
  return values_.empty() ? no_number : values_.back().first;
}

double Reduced::result() {
  if (failed_) return no_number;
  if (rule_.kind == Reduction::count) return count_;
  if (!any_) return no_number;
  if (half_before_ >= 0.0) weigh(last_, half_before_);
  half_before_ = -1.0;
  const double weight = weight_.value();
  switch (rule_.kind) {
    case Reduction::min:
      return low_;
    case Reduction::max:
      return high_;
    case Reduction::absmax:
      return std::max(std::abs(low_), std::abs(high_));
    case Reduction::first:
      return first_;
    case Reduction::final:
      return last_;
    case Reduction::peak_to_peak:
      return high_ - low_;
    case Reduction::percentile:
      return percentile();
    default:
      break;
  }
  if (!(weight > 0.0)) return no_number;
  switch (rule_.kind) {
    case Reduction::mean:
      return sum_.value() / weight;
    case Reduction::rms:
      return std::sqrt(squares_.value() / weight);
    case Reduction::standard_deviation:
      return std::sqrt(spread_ / weight);
    default:
      return beyond_.value() / weight;
  }
}

}  // namespace freeplay
