// StepResolution: whether what depends on time alone is smooth over a step.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace freeplay {

/// Compares signals at many instants of a step with the polynomial of degree 4 through five of them. An integrator
/// whose stages lie about as close as these five sees what the polynomial shows; what it does not show may have been
/// stepped over. Allocates only when it is made.
class StepResolution {
 public:
  static constexpr double tolerance = 0.01;  ///< of a signal's range in the step
  static constexpr double strict = 1e-3;     ///< the same, where no more than a corner can be inside
  static constexpr double finest = 2e-5;     ///< where means and peaks follow the signal alone, by parabolas
  static constexpr double rounding = 1e-12;  ///< of the largest signal: no change

  explicit StepResolution(std::size_t most_signals)
      : nodes_(5 * most_signals), now_(most_signals), low_(most_signals), high_(most_signals), worst_(most_signals) {}

  /// The length, dt or less, of a step from t that resolves `count` signals; one of `least` always does.
  /// `look(t, double*)` fills the signals; where it returns false the search ends, as the step will meet that.
  /// `instants(t, dt)` makes what gives one time after the other at which to look; the last is t + dt or later.
  /// Steps shorter than `strict_below` are judged strictly, or by another `part`: a change that they are a small part
  /// of is smooth in them, unless it begins there.
  /// `negligible(c, dt)` is a range of signal c that does not matter in such a step.
  template <class Look, class Instants, class Negligible>
  double resolved(double t, double dt, double least, double strict_below, std::size_t count, Look&& look,
                  Instants&& instants, Negligible&& negligible, double part = strict) {
    while (dt > least) {
      const double change = sampled(t, dt, dt <= strict_below ? part : tolerance, count, look, instants, negligible);
      if (change < 0.0) return dt;
      // What begins late in the step is left to the next one.
      dt = std::max(change > 0.125 * dt ? change : 0.5 * dt, least);
    }
    return dt;
  }

  /// Whether a signal changed by more than is negligible in the last look.
  bool saw_change() const { return saw_change_; }
  /// Whether one is no polynomial of degree 4 there, to the strict part.
  bool saw_bend() const { return saw_bend_; }

 private:
  /// If the step is too long, the part of it before a signal changes; else -1.
  template <class Look, class Instants, class Negligible>
  double sampled(double t, double dt, double part, std::size_t count, Look& look, Instants& instants,
                 Negligible& negligible) {
    const double end = t + dt;
    double size = 0.0;
    for (std::size_t k = 0; k < 5; ++k) {
      double* const values = &nodes_[k * count];
      if (!look(k == 4 ? end : t + 0.25 * static_cast<double>(k) * dt, values)) return -1.0;
      for (std::size_t c = 0; c < count; ++c) {
        low_[c] = k == 0 ? values[c] : std::min(low_[c], values[c]);
        high_[c] = k == 0 ? values[c] : std::max(high_[c], values[c]);
        size = std::max(size, std::abs(values[c]));
      }
    }
    std::fill(worst_.begin(), worst_.end(), 0.0);
    auto next = instants(t, dt);
    for (double now = next(); now < end; now = next()) {
      if (!look(now, now_.data())) return -1.0;
      const std::array<double, 5> weights = lagrange(4.0 * (now - t) / dt);
      for (std::size_t c = 0; c < count; ++c) {
        const double value = now_[c];
        low_[c] = std::min(low_[c], value);
        high_[c] = std::max(high_[c], value);
        size = std::max(size, std::abs(value));
        double expected = 0.0;
        for (std::size_t k = 0; k < 5; ++k) expected += weights[k] * nodes_[k * count + c];
        worst_[c] = std::max(worst_[c], std::abs(value - expected));
      }
    }
    const auto changes = [&](std::size_t c) {
      return high_[c] - low_[c] > std::max(rounding * size, negligible(c, dt));
    };
    const auto differs = [&](std::size_t c, double by) { return changes(c) && worst_[c] > by * (high_[c] - low_[c]); };
    const auto coarse = [&](std::size_t c) { return differs(c, part); };
    bool any = false;
    saw_change_ = saw_bend_ = false;
    for (std::size_t c = 0; c < count; ++c) {
      any = any || coarse(c);
      saw_change_ = saw_change_ || changes(c);
      saw_bend_ = saw_bend_ || differs(c, strict);
    }
    if (!any) return -1.0;
    double quiet = 0.0;
    next = instants(t, dt);
    for (double now = next(); now < end; now = next()) {
      if (!look(now, now_.data())) return 0.0;
      for (std::size_t c = 0; c < count; ++c) {
        if (coarse(c) && std::abs(now_[c] - nodes_[c]) > part * (high_[c] - low_[c])) return quiet;
      }
      quiet = now - t;
    }
    return 0.0;
  }

  /// Weights of the values at 0, 1, 2, 3 and 4 in that at x.
  static std::array<double, 5> lagrange(double x) {
    const double a = x, b = x - 1.0, c = x - 2.0, d = x - 3.0, e = x - 4.0;
    return {b * c * d * e / 24.0, -a * c * d * e / 6.0, a * b * d * e / 4.0, -a * b * c * e / 6.0,
            a * b * c * d / 24.0};
  }

  bool saw_change_ = false, saw_bend_ = false;
  std::vector<double> nodes_, now_, low_, high_, worst_;
};

}  // namespace freeplay
