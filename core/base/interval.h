// Interval: a closed range of numbers, and what functions of a number in it can come to.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace freeplay {

/// [low, high]. The operations below contain every result of numbers in their operands, but for rounding: what is
/// that close to a bound is not distinguished (Moore, Kearfott and Cloud, Introduction to Interval Analysis, 2009).
struct Interval {
  double low = 0.0, high = 0.0;

  static Interval at(double x) { return {x, x}; }
  static Interval whole() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  bool contains(double x) const { return low <= x && x <= high; }
  bool operator==(double x) const { return low == x && high == x; }
  bool is_finite() const { return std::isfinite(low) && std::isfinite(high); }
};

/// Bounds that are no numbers, as of infinity less infinity, bound nothing.
inline Interval bounds(double low, double high) {
  const Interval whole = Interval::whole();
  return {std::isnan(low) ? whole.low : low, std::isnan(high) ? whole.high : high};
}
inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}
/// Where both bound the same number; roundings may leave nothing in between, then `a` stays.
inline Interval both(const Interval& a, const Interval& b) {
  const Interval out{std::max(a.low, b.low), std::min(a.high, b.high)};
  return out.low <= out.high ? out : a;
}

inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator+(const Interval& a, const Interval& b) { return bounds(a.low + b.low, a.high + b.high); }
inline Interval operator-(const Interval& a, const Interval& b) { return bounds(a.low - b.high, a.high - b.low); }
inline Interval operator*(const Interval& a, const Interval& b) {
  // A bound of zero is a number, however far the other one may be from zero.
  const auto times = [](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : x * y; };
  const double p = times(a.low, b.low), q = times(a.low, b.high), r = times(a.high, b.low), s = times(a.high, b.high);
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
inline Interval operator*(double a, const Interval& b) { return Interval::at(a) * b; }
inline Interval inverse(const Interval& a) {
  return a.contains(0.0) ? Interval::whole() : Interval{1.0 / a.high, 1.0 / a.low};
}
inline Interval operator/(const Interval& a, const Interval& b) {
  return b.contains(0.0) ? Interval::whole() : a * inverse(b);
}
inline Interval square(const Interval& a) {
  const double low = a.low * a.low, high = a.high * a.high;
  return {a.contains(0.0) ? 0.0 : std::min(low, high), std::max(low, high)};
}
inline Interval times_square(const Interval& a, const Interval& x) { return a * square(x); }

inline Interval sin(const Interval& x) {
  constexpr double pi = 3.14159265358979323846;
  if (!x.is_finite() || !(x.high - x.low < 2.0 * pi)) return {-1.0, 1.0};
  const double a = std::sin(x.low), b = std::sin(x.high);
  // Whether a crest, pi/2 + 2 k pi, lies inside; or a trough.
  const auto inside = [&](double first) {
    return first + 2.0 * pi * std::ceil((x.low - first) / (2.0 * pi)) <= x.high;
  };
  return {inside(-0.5 * pi) ? -1.0 : std::min(a, b), inside(0.5 * pi) ? 1.0 : std::max(a, b)};
}
inline Interval cos(const Interval& x) {
  constexpr double pi = 3.14159265358979323846;
  if (!x.is_finite() || !(x.high - x.low < 2.0 * pi)) return {-1.0, 1.0};
  const double a = std::cos(x.low), b = std::cos(x.high);
  const auto inside = [&](double first) {
    return first + 2.0 * pi * std::ceil((x.low - first) / (2.0 * pi)) <= x.high;
  };
  return {inside(-pi) ? -1.0 : std::min(a, b), inside(0.0) ? 1.0 : std::max(a, b)};
}
inline Interval exp(const Interval& x) { return {std::exp(x.low), std::exp(x.high)}; }

/// x^n over the part of `x` where it is a number.
inline Interval pow(const Interval& x, double n) {
  if (n == 0.0) return Interval::at(1.0);
  const bool integer = n == std::floor(n);
  if (integer && x.contains(0.0)) {
    if (n < 0.0) return Interval::whole();
    const double low = std::pow(x.low, n), high = std::pow(x.high, n);
    return std::fmod(n, 2.0) == 0.0 ? Interval{0.0, std::max(low, high)} : Interval{low, high};
  }
  const double a = std::pow(integer ? x.low : std::max(x.low, 0.0), n);
  const double b = std::pow(integer ? x.high : std::max(x.high, 0.0), n);
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace freeplay
