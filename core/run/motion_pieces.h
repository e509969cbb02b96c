// MotionPieces: channels of the motion along a step, as cubics over four equal pieces of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/interval_jet.h"
#include "run/event_finder.h"

namespace freeplay {

class MotionPieces {
 public:
  static constexpr std::size_t count = 4;
  explicit MotionPieces(std::size_t channels) {
    for (std::vector<Jet>& each : ends_) each.resize(channels);
  }

  /// Values and rates at the end of piece k - 1, which is the begin of piece k.
  std::span<Jet> end(std::size_t k) { return ends_[k]; }
  /// Rates where values alone are known: of the polynomial through the five. For after take().
  void fit_rates() {
    for (std::size_t c = 0; c < ends_[0].size(); ++c) {
      const auto f = [&](std::size_t k) { return ends_[k][c].value; };
      const double by = static_cast<double>(count) / (12.0 * dt_);
      ends_[0][c].rate = by * (-25.0 * f(0) + 48.0 * f(1) - 36.0 * f(2) + 16.0 * f(3) - 3.0 * f(4));
      ends_[1][c].rate = by * (-3.0 * f(0) - 10.0 * f(1) + 18.0 * f(2) - 6.0 * f(3) + f(4));
      ends_[2][c].rate = by * (f(0) - 8.0 * f(1) + 8.0 * f(3) - f(4));
      ends_[3][c].rate = by * (-f(0) + 6.0 * f(1) - 18.0 * f(2) + 10.0 * f(3) + 3.0 * f(4));
      ends_[4][c].rate = by * (3.0 * f(0) - 16.0 * f(1) + 36.0 * f(2) - 48.0 * f(3) + 25.0 * f(4));
    }
  }
  /// Of the step: its begin and its length [s].
  void take(double start, double dt) { start_ = start, dt_ = dt; }
  double time(double s) const { return start_ + s * dt_; }
  double length() const { return dt_; }

  void values_at_end(std::size_t k, std::span<double> values) const {
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = ends_[k][c].value;
  }
  /// Where values can be in the whole step, by both its ends: the hull of the cubic's control points, made wider by an
  /// eighth to both sides for what a cubic does not follow.
  void reach(std::span<Interval> ranges) const {
    for (std::size_t c = 0; c < ranges.size(); ++c) {
      const Jet &begin = ends_[0][c], &end = ends_[count][c];
      const auto [low, high] =
          std::minmax({begin.value, begin.value + dt_ / 3.0 * begin.rate, end.value - dt_ / 3.0 * end.rate, end.value});
      const double more = 0.125 * (high - low);
      ranges[c] = {low - more, high + more};
    }
  }

  /// Values at the fraction s of the step.
  void at(double s, std::span<double> values) const {
    const std::size_t k = piece(s);
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = cubic(c, k).at(local(s, k));
  }
  /// In a span of one piece, by fractions of the step.
  void bound(double from, double to, std::span<IntervalJet> ranges, std::span<Jet> middles) const {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from) * dt_, unit = dt_ / count;
    const std::size_t k = piece(middle);
    for (std::size_t c = 0; c < ranges.size(); ++c) {
      const Hermite curve = cubic(c, k);
      const double s = local(middle, k);
      middles[c] = {curve.at(s), curve.slope(s) / unit, curve.bend(s) / (unit * unit)};
      const double bends[] = {curve.bend(local(from, k)) / (unit * unit), curve.bend(local(to, k)) / (unit * unit)};
      ranges[c] = unknown_jet();
      ranges[c].acceleration = hull(Interval::at(bends[0]), Interval::at(bends[1]));
      tighten(ranges[c], middles[c], half);
    }
  }

 private:
  static std::size_t piece(double s) {
    const double k = s * static_cast<double>(count);
    return k < 1.0 ? 0 : std::min(static_cast<std::size_t>(k), count - 1);
  }
  static double local(double s, std::size_t k) { return s * static_cast<double>(count) - static_cast<double>(k); }
  Hermite cubic(std::size_t channel, std::size_t k) const {
    const Jet &begin = ends_[k][channel], &end = ends_[k + 1][channel];
    const double unit = dt_ / static_cast<double>(count);
    return {begin.value, unit * begin.rate, end.value, unit * end.rate};
  }

  double start_ = 0.0, dt_ = 1.0;
  std::array<std::vector<Jet>, count + 1> ends_;
};

}  // namespace freeplay
