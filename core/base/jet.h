// Jet: a function of time with its first and second derivative.
#pragma once

#include <cmath>
#include <concepts>

namespace freeplay {

/// f(t), f'(t), f''(t), at an instant as numbers (Jet) or over a span as their ranges (IntervalJet). The operators
/// below apply the sum, product and chain rules exactly: (g o f)' = g'(f) f',  (g o f)'' = g''(f) f'^2 + g'(f) f''. At
/// a kink of abs, min and max the derivatives are those from the right in t. Outside of a domain the result is not
/// finite; nothing is checked here.
template <typename Number>
struct JetOf {
  Number value{}, rate{}, acceleration{};

  static JetOf constant(const Number& value) { return {value, {}, {}}; }
  static JetOf time(double t) requires std::same_as<Number, double> { return {t, 1.0, 0.0}; }

  bool is_constant() const { return rate == 0.0 && acceleration == 0.0; }
  /// The value and the first `order` derivatives.
  bool is_finite(int order = 2) const requires std::same_as<Number, double> {
    // A difference of a number from itself is zero unless it is not finite.
    if (order >= 2) return (value - value) + (rate - rate) + (acceleration - acceleration) == 0.0;
    return std::isfinite(value) && (order < 1 || std::isfinite(rate));
  }
};
using Jet = JetOf<double>;

inline double square(double x) { return x * x; }
/// a x^2; an interval has one of its own, as a square is not negative.
inline double times_square(double a, double x) { return a * x * x; }

/// g(x(t)) from g, g', g'' at x. A constant x stays constant, even where a derivative of g is infinite (sqrt at 0).
template <typename Number>
JetOf<Number> chain(const Number& g, const Number& g1, const Number& g2, const JetOf<Number>& x) {
  if (x.is_constant()) return JetOf<Number>::constant(g);
  return {g, g1 * x.rate, times_square(g2, x.rate) + g1 * x.acceleration};
}

template <typename Number>
JetOf<Number> operator-(const JetOf<Number>& a) {
  return {-a.value, -a.rate, -a.acceleration};
}
template <typename Number>
JetOf<Number> operator+(const JetOf<Number>& a, const JetOf<Number>& b) {
  return {a.value + b.value, a.rate + b.rate, a.acceleration + b.acceleration};
}
template <typename Number>
JetOf<Number> operator-(const JetOf<Number>& a, const JetOf<Number>& b) {
  return {a.value - b.value, a.rate - b.rate, a.acceleration - b.acceleration};
}
template <typename Number>
JetOf<Number> operator*(const JetOf<Number>& a, const JetOf<Number>& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.acceleration * b.value + 2.0 * (a.rate * b.rate) + a.value * b.acceleration};
}
template <typename Number>
JetOf<Number> operator/(const JetOf<Number>& a, const JetOf<Number>& b) {
  // From a = q b: a' = q' b + q b', a'' = q'' b + 2 q' b' + q b''.
  const Number q = a.value / b.value;
  const Number rate = (a.rate - q * b.rate) / b.value;
  return {q, rate, (a.acceleration - 2.0 * (rate * b.rate) - q * b.acceleration) / b.value};
}

template <typename Number>
JetOf<Number> sin(const JetOf<Number>& x) {
  using std::cos, std::sin;
  const Number s = sin(x.value), c = cos(x.value);
  return chain(s, c, -s, x);
}
template <typename Number>
JetOf<Number> cos(const JetOf<Number>& x) {
  using std::cos, std::sin;
  const Number s = sin(x.value), c = cos(x.value);
  return chain(c, -s, -c, x);
}
template <typename Number>
JetOf<Number> exp(const JetOf<Number>& x) {
  using std::exp;
  const Number g = exp(x.value);
  return chain(g, g, g, x);
}
/// x^n for a constant exponent; x may be negative when n is an integer.
template <typename Number>
JetOf<Number> pow(const JetOf<Number>& x, double n) {
  using std::pow;
  // A factor n or n - 1 of zero ends the series; 0 * infinity would spoil it at x = 0.
  const Number g1 = n == 0.0 ? Number{} : n * pow(x.value, n - 1.0);
  const Number g2 = n == 0.0 || n == 1.0 ? Number{} : n * (n - 1.0) * pow(x.value, n - 2.0);
  return chain<Number>(pow(x.value, n), g1, g2, x);
}
/// With the derivatives of the angle of the point (x, y), whose value is `angle`.
template <typename Number>
JetOf<Number> of_angle(const Number& angle, const JetOf<Number>& y, const JetOf<Number>& x) {
  if (y.is_constant() && x.is_constant()) return JetOf<Number>::constant(angle);
  // r2 a' = x y' - y x' =: w, and by differentiating once more, r2 a'' = w' - (r2)' a'.
  const Number r2 = square(x.value) + square(y.value);
  const Number w = x.value * y.rate - y.value * x.rate;
  const Number w1 = x.value * y.acceleration - y.value * x.acceleration;
  const Number r2_rate = 2.0 * (x.value * x.rate + y.value * y.rate), rate = w / r2;
  return {angle, rate, (w1 - r2_rate * rate) / r2};
}

inline Jet tan(const Jet& x) {
  const double g = std::tan(x.value), g1 = 1.0 + g * g;
  return chain(g, g1, 2.0 * g * g1, x);
}
/// tanh' = 1 - tanh^2, tanh'' = -2 tanh (1 - tanh^2).
inline Jet tanh(const Jet& x) {
  const double g = std::tanh(x.value), g1 = 1.0 - g * g;
  return chain(g, g1, -2.0 * g * g1, x);
}
inline Jet asin(const Jet& x) {
  const double w = (1.0 - x.value) * (1.0 + x.value), g1 = 1.0 / std::sqrt(w);
  return chain(std::asin(x.value), g1, x.value * g1 / w, x);
}
inline Jet acos(const Jet& x) {
  const double w = (1.0 - x.value) * (1.0 + x.value), g1 = -1.0 / std::sqrt(w);
  return chain(std::acos(x.value), g1, x.value * g1 / w, x);
}
inline Jet sqrt(const Jet& x) {
  const double g = std::sqrt(x.value), g1 = 0.5 / g;
  return chain(g, g1, -0.5 * g1 / x.value, x);
}
inline Jet log(const Jet& x) {
  const double g1 = 1.0 / x.value;
  return chain(std::log(x.value), g1, -g1 * g1, x);
}

/// True if a(t) < b(t) just right of the present time.
inline bool less_from_right(const Jet& a, const Jet& b) {
  if (a.value != b.value) return a.value < b.value;
  if (a.rate != b.rate) return a.rate < b.rate;
  return a.acceleration < b.acceleration;
}
inline Jet min(const Jet& a, const Jet& b) { return less_from_right(b, a) ? b : a; }
inline Jet max(const Jet& a, const Jet& b) { return less_from_right(a, b) ? b : a; }
inline Jet abs(const Jet& x) { return less_from_right(x, Jet{}) ? -x : x; }

/// Angle of the point (x, y), continuous through its derivatives; the value is in [-pi, pi].
inline Jet atan2(const Jet& y, const Jet& x) { return of_angle(std::atan2(y.value, x.value), y, x); }

/// x^n = exp(n log x) for an exponent that depends on time; x must be positive.
inline Jet pow(const Jet& x, const Jet& n) {
  Jet result = exp(n * log(x));
  result.value = std::pow(x.value, n.value);
  return result;
}

/// 0 for x <= a, 1 for x >= b and 6 s^5 - 15 s^4 + 10 s^3 with s = (x - a)/(b - a) in between; needs a < b. The second
/// derivative is continuous.
inline Jet smooth(const Jet& x, const Jet& a, const Jet& b) {
  if (x.value <= a.value) return Jet::constant(0.0);
  if (x.value >= b.value) return Jet::constant(1.0);
  const Jet s = (x - a) / (b - a);
  const double v = s.value;
  return chain(v * v * v * (v * (6.0 * v - 15.0) + 10.0), 30.0 * v * v * (v - 1.0) * (v - 1.0),
               60.0 * v * (v - 1.0) * (2.0 * v - 1.0), s);
}

}  // namespace freeplay
