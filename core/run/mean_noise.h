// MeanNoise: how far the digits of means over time mean anything in a run in which chance has a part.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace freeplay {

/// By how much the mean of `parts`, which are as long as each other, varies from run to run: the spread of parts that a
/// drive makes alike. Of all distances in time that one counts whose parts differ least, so that what comes again with
/// the drive, or changes slowly, is no chance; parts are as long as an impact is to be expected in each of them, at
/// least, and longer ones count where their spread says more, as chance that lasts makes it.
[[gnu::cold]] double noise_of_mean(std::span<const double> parts, double events);

/// Notes sums over time at 64 instants, a comparison for each step.
class MeanNoise {
 public:
  static constexpr std::size_t parts = 64;
  /// Of `count` sums, from the time `from` to `end`; of none where nothing is left to chance.
  MeanNoise(double from, double end, std::size_t count);

  /// Whether the sums at t are to be noted.
  bool is_due(double t) const { return count_ > 0 && noted_ <= parts && t >= next_; }
  /// Room for them, in order.
  std::span<double> note(double t);
  /// By how much sum `i` varies when it is `last` at the time t, with so many impacts until then.
  [[gnu::cold]] double of(std::size_t i, double t, double last, double events) const;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.next_, self.noted_, self.samples_);
  }

 private:
  double from_, length_, next_;  ///< [s]
  std::size_t count_, noted_ = 0;
  std::vector<double> samples_;  ///< of each instant its time, then the sums
};

}  // namespace freeplay
