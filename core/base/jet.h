// Jet: a function of time with its first and second derivative.
#pragma once

#include <cmath>

namespace freeplay {

/// f(t), f'(t), f''(t). The operators below apply the sum, product and chain rules exactly:
/// (g o f)' = g'(f) f',  (g o f)'' = g''(f) f'^2 + g'(f) f''. At a kink of abs, min and max the derivatives are those
/// from the right in t. Outside of a domain the result is not finite; nothing is checked here.
struct Jet {
  double value = 0.0, rate = 0.0, acceleration = 0.0;

  static Jet constant(double value) { return {value, 0.0, 0.0}; }
  static Jet time(double t) { return {t, 1.0, 0.0}; }

  bool is_constant() const { return rate == 0.0 && acceleration == 0.0; }
  /// The value and the first `order` derivatives.
  bool is_finite(int order = 2) const {
    // A difference of a number from itself is zero unless it is not finite.
    if (order >= 2) return (value - value) + (rate - rate) + (acceleration - acceleration) == 0.0;
    return std::isfinite(value) && (order < 1 || std::isfinite(rate));
  }
};

/// g(x(t)) from g, g', g'' at x. A constant x stays constant, even where a derivative of g is infinite (sqrt at 0).
inline Jet chain(double g, double g1, double g2, const Jet& x) {
  if (x.is_constant()) return Jet::constant(g);
  return {g, g1 * x.rate, g2 * x.rate * x.rate + g1 * x.acceleration};
}

inline Jet operator-(const Jet& a) { return {-a.value, -a.rate, -a.acceleration}; }
inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.rate + b.rate, a.acceleration + b.acceleration};
}
inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.rate - b.rate, a.acceleration - b.acceleration};
}
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.acceleration * b.value + 2.0 * a.rate * b.rate + a.value * b.acceleration};
}
inline Jet operator/(const Jet& a, const Jet& b) {
  // From a = q b: a' = q' b + q b', a'' = q'' b + 2 q' b' + q b''.
  const double q = a.value / b.value;
  const double rate = (a.rate - q * b.rate) / b.value;
  return {q, rate, (a.acceleration - 2.0 * rate * b.rate - q * b.acceleration) / b.value};
}

inline Jet sin(const Jet& x) {
  const double s = std::sin(x.value), c = std::cos(x.value);
  return chain(s, c, -s, x);
}
inline Jet cos(const Jet& x) {
  const double s = std::sin(x.value), c = std::cos(x.value);
  return chain(c, -s, -c, x);
}
inline Jet tan(const Jet& x) {
  const double g = std::tan(x.value), g1 = 1.0 + g * g;
  return chain(g, g1, 2.0 * g * g1, x);
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
inline Jet exp(const Jet& x) {
  const double g = std::exp(x.value);
  return chain(g, g, g, x);
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
inline Jet atan2(const Jet& y, const Jet& x) {
  const double value = std::atan2(y.value, x.value);
  if (y.is_constant() && x.is_constant()) return Jet::constant(value);
  // r2 a' = x y' - y x' =: w, and by differentiating once more, r2 a'' = w' - (r2)' a'.
  const double r2 = x.value * x.value + y.value * y.value;
  const double w = x.value * y.rate - y.value * x.rate;
  const double w1 = x.value * y.acceleration - y.value * x.acceleration;
  const double r2_rate = 2.0 * (x.value * x.rate + y.value * y.rate);
  return {value, w / r2, (w1 - r2_rate * (w / r2)) / r2};
}

/// x^n for a constant exponent; x may be negative when n is an integer.
inline Jet pow(const Jet& x, double n) {
  // A factor n or n - 1 of zero ends the series; 0 * infinity would spoil it at x = 0.
  const double g1 = n == 0.0 ? 0.0 : n * std::pow(x.value, n - 1.0);
  const double g2 = n == 0.0 || n == 1.0 ? 0.0 : n * (n - 1.0) * std::pow(x.value, n - 2.0);
  return chain(std::pow(x.value, n), g1, g2, x);
}
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
