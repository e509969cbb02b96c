// Courses: channels over time in few numbers, with every extreme.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/json_text.h"

namespace freeplay {

/// Row k of n belongs to bucket j of B with floor(j n/B) <= k < floor((j+1) n/B).
inline std::size_t bucket_begin(std::size_t bucket, std::size_t rows, std::size_t buckets) {
  return bucket * rows / buckets;
}

/// Minimum and maximum of each bucket of rows; without buckets the rows themselves. NaN counts for neither.
class Courses {
 public:
  /// `buckets`: 0 where rows are kept as they are.
  Courses(std::size_t channels, std::size_t rows, std::size_t buckets);

  /// The next row: its time, then a number for each channel.
  void row(std::span<const double> row);
  std::size_t rows() const { return row_; }

  double min(std::size_t channel) const { return low_[channel].value; }
  double max(std::size_t channel) const { return high_[channel].value; }
  /// Middle between the extremes of all rows; 0 where there is none.
  double offset(std::size_t channel) const;
  /// `min, max, min_time, max_time, offset, values` of the page, and how many rows are `missing` where some are.
  void describe(std::size_t channel, Json& json) const;
  /// Time of each row, or the first of each bucket and the last of all, in base64.
  std::string times() const;

 private:
  struct Extreme {
    double value, time;
  };

  void begin_bucket(double time);

  std::size_t channels_, all_, buckets_, row_ = 0, bucket_ = 0, next_ = 0;
  std::vector<double> times_;
  double last_ = 0.0;
  std::vector<double> bucket_low_, bucket_high_;  // of the present bucket
  std::vector<Extreme> low_, high_;               // of all rows
  std::vector<std::vector<double>> values_;       // by channel
  std::vector<std::size_t> missing_;              // rows without a number, by channel
};

}  // namespace freeplay
