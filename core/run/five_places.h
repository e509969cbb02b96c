// FivePlaces: a function of time along a step, as a polynomial through five values shows it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/formula_bounds.h"

namespace freeplay {

struct FivePlaces {
  double part = 1.0;              ///< of the step that they cover, from its begin
  std::array<double, 5> shown{};  ///< at the ends of quarters of that part

  double low() const { return *std::ranges::min_element(shown); }
  double high() const { return *std::ranges::max_element(shown); }

  /// The polynomial of degree 4 through what is shown, with its derivatives by time, at the fraction s of a step of
  /// `length` [s].
  Jet polynomial(double s, double length) const {
    // Newton's form by differences, x growing by 1 in each quarter.
    const double by = part * length / 4.0;
    const Jet x{4.0 * s / part, 1.0 / by, 0.0};
    std::array<double, 5> difference = shown;
    for (std::size_t order = 1; order < 5; ++order) {
      for (std::size_t k = 4; k >= order; --k) {
        difference[k] = (difference[k] - difference[k - 1]) / static_cast<double>(order);
      }
    }
    Jet out = Jet::constant(difference[4]);
    for (std::size_t k = 4; k > 0; --k) {
      out = out * (x - Jet::constant(static_cast<double>(k - 1))) + Jet::constant(difference[k - 1]);
    }
    return out;
  }
  /// Whether a function with these bounds in a span of the step is the polynomial there, to `allowed`.
  bool show(const FormulaBounds::Bounds& bounds, double from, double to, double length, double allowed) const {
    const double half = 0.5 * (to - from) * length;
    const Jet begin = polynomial(from, length), middle = polynomial(0.5 * (from + to), length),
              end = polynomial(to, length);
    // The second derivative of the polynomial is a parabola.
    const auto bend = std::minmax({begin.acceleration, middle.acceleration, end.acceleration});
    const double more = std::abs(begin.acceleration - 2.0 * middle.acceleration + end.acceleration);
    IntervalJet off = bounds.range;
    off.value = off.value - hull(hull(Interval::at(begin.value), Interval::at(end.value)), Interval::at(middle.value));
    off.rate = Interval::whole();
    off.acceleration = off.acceleration - Interval{bend.first - more, bend.second + more};
    tighten(off, bounds.at_middle - middle, half);
    return off.value.low >= -allowed && off.value.high <= allowed;
  }
};

}  // namespace freeplay
