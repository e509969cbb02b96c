#include "run/mean_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace freeplay {
namespace {

constexpr std::size_t fewest_parts = 8;  // that say something of a spread

}  // namespace

double noise_of_mean(std::span<const double> parts, double events) {
  const std::size_t n = parts.size();
  if (n < 2 * fewest_parts) return 0.0;
  std::vector<double> sum{0.0};
  for (const double part : parts) sum.push_back(sum.back() + part);
  std::size_t length = 1;
  while (static_cast<double>(n) > events * static_cast<double>(length) && length < n / fewest_parts) length *= 2;
  double variance = -1.0;
  for (; length <= n / fewest_parts; length *= 2) {
    const auto mean = [&](std::size_t k) { return (sum[k + length] - sum[k]) / static_cast<double>(length); };
    const std::size_t means = n - length + 1;
    double least = std::numeric_limits<double>::infinity();
    std::size_t apart = 0;
    for (std::size_t lag = length; lag <= n / 2; ++lag) {
      double squares = 0.0;
      for (std::size_t k = 0; k + lag < means; ++k) squares += std::pow(mean(k + lag) - mean(k), 2);
      const double half = 0.5 * squares / static_cast<double>(means - lag);
      if (half < least) least = half, apart = lag;
    }
    const double now = least * static_cast<double>(length) / static_cast<double>(n);
    // Neighbours that differ least show a slow change, and longer parts the more of it.
    if (variance < 0.0 || apart > length) variance = std::max(variance, now);
  }
  return std::sqrt(std::max(variance, 0.0));
}

MeanNoise::MeanNoise(double from, double end, std::size_t count)
    : from_(from),
      length_((end - from) / static_cast<double>(parts)),
      next_(from),
      count_(count),
      samples_(count > 0 ? (parts + 1) * (count + 1) : 0) {}

std::span<double> MeanNoise::note(double t) {
  const std::span<double> sample = std::span(samples_).subspan(noted_ * (count_ + 1), count_ + 1);
  sample[0] = t;
  ++noted_;
  // A long step goes over several of them.
  while (next_ <= t && length_ > 0.0) next_ += length_;
  return sample.subspan(1);
}

double MeanNoise::of(std::size_t i, double t, double last, double events) const {
  if (noted_ < 2 * fewest_parts || !(t > from_)) return 0.0;
  const auto time = [&](std::size_t k) { return k < noted_ ? samples_[k * (count_ + 1)] : t; };
  const auto value = [&](std::size_t k) { return k < noted_ ? samples_[k * (count_ + 1) + 1 + i] : last; };
  const double begin = time(0), length = (t - begin) / static_cast<double>(parts);
  std::array<double, parts> rates{};
  double before = value(0);
  std::size_t k = 0;
  for (std::size_t p = 0; p < parts; ++p) {
    const double end = begin + static_cast<double>(p + 1) * length;
    while (k < noted_ && time(k) < end) ++k;
    double here = value(k);
    if (k > 0 && time(k) > time(k - 1)) {
      const double share = std::min(1.0, (end - time(k - 1)) / (time(k) - time(k - 1)));
      here = value(k - 1) + share * (value(k) - value(k - 1));
    }
    rates[p] = here - before;
    before = here;
  }
  return static_cast<double>(parts) * noise_of_mean(rates, events);
}

}  // namespace freeplay
