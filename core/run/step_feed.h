// StepFeed: what a StepSink wants of each step.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "run/step_sink.h"

namespace freeplay {

/// The functions `look` take an instant of the step and fill the row `inside`; false where nothing can be seen there.
class StepFeed {
 public:
  StepFeed(int time, std::size_t channels) : time_(time), before_(channels), inside_(channels) {}

  void feed(StepSink* sink) { sink_ = sink; }
  bool active() const { return sink_ != nullptr; }
  void see_inside(std::span<const double> row) {
    if (sink_ != nullptr) sink_->inside(row);
  }
  /// Room for a row inside of a step.
  std::span<double> inside() { return inside_; }

  /// Rows at the instants that are wanted inside of a step up to `end`. False where `look` is.
  template <class Look>
  bool give_instants(double begin, double end, Look&& look) {
    if (sink_ == nullptr) return true;
    const double met = met_by(begin, end);
    while (sink_->next_instant() < end - met) {
      if (!look(sink_->next_instant())) return false;
      sink_->instant(inside_);
    }
    return true;
  }

  /// Passages inside of the step that ends with `row`, and that row. `look` may fail: values are then taken as
  /// straight.
  template <class Look>
  void give_step(std::span<const double> row, Look&& look) {
    const double end = row[time()], begin = began_ ? before_[time()] : end;
    if (began_) give_passages(row, look);
    while (sink_->next_instant() <= end + met_by(begin, end)) sink_->instant(row);
    sink_->step(row);
    std::ranges::copy(row, before_.begin());
    began_ = true;
  }
  /// The row at `t` as if all went straight.
  void look_straight(double t, std::span<const double> row) {
    const double s = (t - before_[time()]) / (row[time()] - before_[time()]);
    for (std::size_t c = 0; c < row.size(); ++c) inside_[c] = (1.0 - s) * before_[c] + s * row[c];
    inside_[time()] = t;
  }

 private:
  std::size_t time() const { return static_cast<std::size_t>(time_); }
  /// An instant so near to the end of a step is met by it.
  static double met_by(double begin, double end) {
    constexpr double of_step = 1e-9, of_time = 8.0 * std::numeric_limits<double>::epsilon();
    return std::max(of_step * (end - begin), of_time * std::abs(end));
  }

  template <class Look>
  void give_passages(std::span<const double> row, Look&& look) {
    const std::span<const StepSink::Passage> passages = sink_->passages();
    for (std::size_t i = 0; i < passages.size(); ++i) {
      const StepSink::Passage& passage = passages[i];
      const std::size_t c = static_cast<std::size_t>(passage.channel);
      const double from = before_[c] - passage.value, to = row[c] - passage.value;
      if (!((passage.up && from <= 0.0 && to > 0.0) || (passage.down && from >= 0.0 && to < 0.0))) continue;
      find_zero(c, passage.value, from, to, row, look);
      sink_->passed(i, inside_);
    }
  }

  /// `inside` becomes the row where the channel has the value: by false positions, and by halves where these creep, as
  /// towards a jump.
  template <class Look>
  void find_zero(std::size_t c, double value, double from, double to, std::span<const double> row, Look&& look) {
    constexpr double near = 1e-12;
    constexpr int most_looks = 60, patience = 12;
    const double start = before_[time()], length = row[time()] - start;
    double low = 0.0, high = 1.0;
    if (from == 0.0) {
      std::ranges::copy(before_, inside_.begin());
      return;
    }
    const bool falls = from > 0.0;
    int kept = 0;  // the end that stayed last: -1 low, 1 high
    for (int looks = 0; looks < most_looks && high - low > near; ++looks) {
      const bool creeps = looks >= patience;
      const double s = creeps ? 0.5 * (low + high) : std::clamp(low - from * (high - low) / (to - from), low, high);
      const double t = start + s * length;
      if (!look(t)) look_straight(t, row);
      const double here = inside_[c] - value;
      if (!(std::abs(here) > 0.0)) return;
      if ((here < 0.0) != falls) {
        low = s, from = here;
        if (kept == 1) to *= 0.5;
        kept = 1;
      } else {
        high = s, to = here;
        if (kept == -1) from *= 0.5;
        kept = -1;
      }
    }
  }

  StepSink* sink_ = nullptr;
  int time_;
  bool began_ = false;
  std::vector<double> before_, inside_;
};

}  // namespace freeplay
