#include "report/courses.h"

#include <cmath>
#include <limits>

#include "report/base64.h"

namespace freeplay {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Courses::Courses(std::size_t channels, std::size_t rows, std::size_t buckets)
    : channels_(channels),
      all_(rows),
      buckets_(buckets),
      bucket_low_(channels, nothing),
      bucket_high_(channels, nothing),
      low_(channels, {nothing, nothing}),
      high_(channels, {nothing, nothing}),
      values_(channels),
      missing_(channels) {
  for (std::vector<double>& values : values_) values.reserve(buckets > 0 ? 2 * buckets : rows);
}

void Courses::begin_bucket(double time) {
  times_.push_back(time);
  next_ = bucket_begin(++bucket_, all_, buckets_);
  bucket_low_.assign(channels_, nothing);
  bucket_high_.assign(channels_, nothing);
}

void Courses::row(std::span<const double> row) {
  last_ = row[0];
  if (buckets_ == 0) {
    times_.push_back(last_);
  } else if (row_ == next_) {
    begin_bucket(last_);
  }
  ++row_;
  for (std::size_t c = 0; c < channels_; ++c) {
    const double x = std::isfinite(row[c + 1]) ? row[c + 1] : nothing;
    // Written so that the first number replaces NaN.
    if (!(bucket_low_[c] <= x) && x == x) {
      bucket_low_[c] = x;
      if (!(low_[c].value <= x)) low_[c] = {x, last_};
    }
    if (!(bucket_high_[c] >= x) && x == x) {
      bucket_high_[c] = x;
      if (!(high_[c].value >= x)) high_[c] = {x, last_};
    }
    if (x != x) ++missing_[c];
    if (buckets_ == 0) values_[c].push_back(x);
  }
  if (buckets_ == 0 || row_ < next_) return;
  for (std::size_t c = 0; c < channels_; ++c) {
    values_[c].push_back(bucket_low_[c]);
    values_[c].push_back(bucket_high_[c]);
  }
}

double Courses::offset(std::size_t channel) const {
  const double middle = 0.5 * low_[channel].value + 0.5 * high_[channel].value;
  return std::isfinite(middle) ? middle : 0.0;
}

void Courses::describe(std::size_t channel, Json& json) const {
  json["min"] = json_number(low_[channel].value);
  json["max"] = json_number(high_[channel].value);
  json["min_time"] = json_number(low_[channel].time);
  json["max_time"] = json_number(high_[channel].time);
  if (missing_[channel] > 0) json["missing"] = missing_[channel];
  json["offset"] = offset(channel);
  json["values"] = base64_floats(values_[channel], offset(channel));
}

std::string Courses::times() const {
  std::vector<double> times = times_;
  if (buckets_ > 0) times.push_back(last_);
  return base64_numbers<double>(times);
}

}  // namespace freeplay
