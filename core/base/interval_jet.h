// IntervalJet: the range of a function of time and of its first and second derivative over a span of time.
#pragma once

#include "base/interval.h"
#include "base/jet.h"

namespace freeplay {

/// What a Jet is at an instant, over a span. Where the rate may jump inside, `acceleration` is unbounded and `rate` has
/// those of both sides, so that the value goes no farther than the rate says; where the value may jump, both are.
struct IntervalJet {
  Interval value, rate, acceleration;

  static IntervalJet constant(const Interval& value) { return {value, {}, {}}; }
  static IntervalJet unknown() { return {Interval::whole(), Interval::whole(), Interval::whole()}; }
  bool is_constant() const { return rate.is(0.0) && acceleration.is(0.0); }

  /// Narrower by Taylor's formula about the middle of the span, where it is `m`.
  void tighten(const Jet& m, double half) {
    if (!m.is_finite()) return;
    const Interval by{-half, half};
    value = both(value, Interval::at(m.value) + rate * by);
    if (!acceleration.is_finite()) return;
    rate = both(rate, Interval::at(m.rate) + acceleration * by);
    value = both(value, Interval::at(m.value) + m.rate * by + acceleration * Interval{0.0, 0.5 * half * half});
  }
};

/// g(x(t)) from the ranges of g, g', g''.
inline IntervalJet chain(const Interval& g, const Interval& g1, const Interval& g2, const IntervalJet& x) {
  if (x.is_constant()) return IntervalJet::constant(g);
  return {g, g1 * x.rate, g2 * square(x.rate) + g1 * x.acceleration};
}

inline IntervalJet operator-(const IntervalJet& a) { return {-a.value, -a.rate, -a.acceleration}; }
inline IntervalJet operator+(const IntervalJet& a, const IntervalJet& b) {
  return {a.value + b.value, a.rate + b.rate, a.acceleration + b.acceleration};
}
inline IntervalJet operator-(const IntervalJet& a, const IntervalJet& b) {
  return {a.value - b.value, a.rate - b.rate, a.acceleration - b.acceleration};
}
inline IntervalJet operator*(const IntervalJet& a, const IntervalJet& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.acceleration * b.value + 2.0 * (a.rate * b.rate) + a.value * b.acceleration};
}
inline IntervalJet operator/(const IntervalJet& a, const IntervalJet& b) {
  const Interval by = inverse(b.value), q = a.value * by, rate = (a.rate - q * b.rate) * by;
  return {q, rate, (a.acceleration - 2.0 * (rate * b.rate) - q * b.acceleration) * by};
}

inline IntervalJet sin(const IntervalJet& x) {
  const Interval s = sin(x.value);
  return chain(s, cos(x.value), -s, x);
}
inline IntervalJet cos(const IntervalJet& x) {
  const Interval c = cos(x.value);
  return chain(c, -sin(x.value), -c, x);
}
inline IntervalJet tan(const IntervalJet& x) {
  const Interval c = cos(x.value);
  if (c.contains(0.0) || !(x.value.high - x.value.low < 3.0)) return IntervalJet::unknown();
  const Interval g{std::tan(x.value.low), std::tan(x.value.high)}, g1 = Interval::at(1.0) + square(g);
  return chain(g, g1, 2.0 * (g * g1), x);
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
inline IntervalJet pow(const IntervalJet& x, double n) {
  const Interval g1 = n == 0.0 ? Interval{} : n * pow(x.value, n - 1.0);
  const Interval g2 = n == 0.0 || n == 1.0 ? Interval{} : n * (n - 1.0) * pow(x.value, n - 2.0);
  return chain(pow(x.value, n), g1, g2, x);
}
inline IntervalJet sqrt(const IntervalJet& x) { return pow(x, 0.5); }
inline IntervalJet exp(const IntervalJet& x) {
  const Interval g = exp(x.value);
  return chain(g, g, g, x);
}
inline IntervalJet log(const IntervalJet& x) {
  const Interval inside{std::max(x.value.low, 0.0), std::max(x.value.high, 0.0)};
  const Interval g1{1.0 / inside.high, 1.0 / inside.low};
  return chain({std::log(inside.low), std::log(inside.high)}, g1, -square(g1), x);
}
inline IntervalJet pow(const IntervalJet& x, const IntervalJet& n) { return exp(n * log(x)); }

/// Of the point (x, y) where it does not pass the half line to the left, on which the angle jumps.
inline IntervalJet atan2(const IntervalJet& y, const IntervalJet& x) {
  const Interval r2 = square(x.value) + square(y.value);
  if (r2.low <= 0.0) return IntervalJet::unknown();
  const double angles[] = {std::atan2(y.value.low, x.value.low), std::atan2(y.value.low, x.value.high),
                           std::atan2(y.value.high, x.value.low), std::atan2(y.value.high, x.value.high)};
  const auto [low, high] = std::minmax_element(std::begin(angles), std::end(angles));
  if (y.is_constant() && x.is_constant()) return IntervalJet::constant({*low, *high});
  const Interval w = x.value * y.rate - y.value * x.rate;
  const Interval w1 = x.value * y.acceleration - y.value * x.acceleration;
  const Interval r2_rate = 2.0 * (x.value * x.rate + y.value * y.rate), rate = w / r2;
  return {{*low, *high}, rate, (w1 - r2_rate * rate) / r2};
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
  if (v.is(0.0) || v.is(1.0)) return IntervalJet::constant(v);
  return chain({g(v.low), g(v.high)}, slope, bend, s);
}

}  // namespace freeplay
