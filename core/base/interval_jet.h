// IntervalJet: the range of a function of time and of its first and second derivative over a span of time.
#pragma once

#include "base/interval.h"
#include "base/jet.h"

namespace freeplay {

/// What a Jet is at an instant, over a span. Where the rate may jump inside, `acceleration` is unbounded and `rate` has
/// those of both sides, so that the value goes no farther than the rate says; where the value may jump, both are.
using IntervalJet = JetOf<Interval>;

inline IntervalJet unknown_jet() { return {Interval::whole(), Interval::whole(), Interval::whole()}; }

/// Narrower by Taylor's formula about the middle of the span, where it is `m`.
inline void tighten(IntervalJet& range, const Jet& m, double half) {
  if (!m.is_finite()) return;
  const Interval by{-half, half};
  range.value = both(range.value, Interval::at(m.value) + range.rate * by);
  if (!range.acceleration.is_finite()) return;
  range.rate = both(range.rate, Interval::at(m.rate) + range.acceleration * by);
  range.value =
      both(range.value, Interval::at(m.value) + m.rate * by + range.acceleration * Interval{0.0, 0.5 * half * half});
}

inline IntervalJet tan(const IntervalJet& x) {
  const Interval c = cos(x.value);
  if (c.contains(0.0) || !(x.value.high - x.value.low < 3.0)) return unknown_jet();
  const Interval g{std::tan(x.value.low), std::tan(x.value.high)}, g1 = Interval::at(1.0) + square(g);
  return chain(g, g1, 2.0 * (g * g1), x);
}
inline IntervalJet tanh(const IntervalJet& x) {
  const Interval g{std::tanh(x.value.low), std::tanh(x.value.high)}, g1 = Interval::at(1.0) - square(g);
  return chain(g, g1, -2.0 * (g * g1), x);
}
/// The derivatives of asin, by which acos falls.
inline IntervalJet asin_like(const Interval& g, double sign, const IntervalJet& x) {
  const Interval w{std::max(x.value.low, -1.0), std::min(x.value.high, 1.0)};
  const auto slope = [](double v) { return 1.0 / std::sqrt((1.0 - v) * (1.0 + v)); };
  const auto bend = [&](double v) { return v == 0.0 ? 0.0 : v * slope(v) * slope(v) * slope(v); };
  const double a = slope(w.low), b = slope(w.high);
  const Interval g1{w.contains(0.0) ? 1.0 : std::min(a, b), std::max(a, b)};
  return chain(g, sign * g1, sign * Interval{bend(w.low), bend(w.high)}, x);
}
inline IntervalJet asin(const IntervalJet& x) {
  return asin_like({std::asin(std::clamp(x.value.low, -1.0, 1.0)), std::asin(std::clamp(x.value.high, -1.0, 1.0))}, 1.0,
                   x);
}
inline IntervalJet acos(const IntervalJet& x) {
  return asin_like({std::acos(std::clamp(x.value.high, -1.0, 1.0)), std::acos(std::clamp(x.value.low, -1.0, 1.0))},
                   -1.0, x);
}
inline IntervalJet sqrt(const IntervalJet& x) { return pow(x, 0.5); }
inline IntervalJet log(const IntervalJet& x) {
  const Interval inside{std::max(x.value.low, 0.0), std::max(x.value.high, 0.0)};
  const Interval g1{1.0 / inside.high, 1.0 / inside.low};
  return chain({std::log(inside.low), std::log(inside.high)}, g1, -square(g1), x);
}
inline IntervalJet pow(const IntervalJet& x, const IntervalJet& n) { return exp(n * log(x)); }

/// Of the point (x, y) where it does not pass the half line to the left, on which the angle jumps.
inline IntervalJet atan2(const IntervalJet& y, const IntervalJet& x) {
  if ((square(x.value) + square(y.value)).low <= 0.0) return unknown_jet();
  const double angles[] = {std::atan2(y.value.low, x.value.low), std::atan2(y.value.low, x.value.high),
                           std::atan2(y.value.high, x.value.low), std::atan2(y.value.high, x.value.high)};
  const auto [low, high] = std::minmax_element(std::begin(angles), std::end(angles));
  return of_angle(Interval{*low, *high}, y, x);
}

/// Its second derivative is continuous, so that its ends are like any other place.
inline IntervalJet smooth(const IntervalJet& x, const IntervalJet& a, const IntervalJet& b) {
  const IntervalJet s = (x - a) / (b - a);
  const Interval v{std::clamp(s.value.low, 0.0, 1.0), std::clamp(s.value.high, 0.0, 1.0)};
  const auto g = [](double u) { return u * u * u * (u * (6.0 * u - 15.0) + 10.0); };
  const auto g1 = [](double u) { return 30.0 * u * u * (u - 1.0) * (u - 1.0); };
  const auto g2 = [](double u) { return 60.0 * u * (u - 1.0) * (2.0 * u - 1.0); };
  // Extremes of g' at 1/2, of g'' at 1/2 -+ 1/sqrt(12).
  constexpr double lower = 0.2113248654051871, upper = 0.7886751345948129;
  Interval slope = hull(Interval::at(g1(v.low)), Interval::at(g1(v.high)));
  Interval bend = hull(Interval::at(g2(v.low)), Interval::at(g2(v.high)));
  if (v.contains(0.5)) slope = hull(slope, Interval::at(g1(0.5)));
  for (const double extreme : {lower, upper}) {
    if (v.contains(extreme)) bend = hull(bend, Interval::at(g2(extreme)));
  }
  if (v == 0.0 || v == 1.0) return IntervalJet::constant(v);
  return chain({g(v.low), g(v.high)}, slope, bend, s);
}

}  // namespace freeplay
