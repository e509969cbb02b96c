// Partials: a number and its derivatives by a few variables.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace freeplay {

/// x and dx by N variables; the rules of differentiation are those of the operators. Nothing is set where it is made.
template <std::size_t N>
struct Partials {
  double value;
  std::array<double, N> slope;

  static Partials constant(double x) {
    Partials p;
    p.value = x;
    for (double& s : p.slope) s = 0.0;
    return p;
  }
  /// Variable number k.
  static Partials variable(double x, std::size_t k) {
    Partials p = constant(x);
    if (k < N) p.slope[k] = 1.0;
    return p;
  }
  /// g(x) from g and g' there.
  static Partials chain(double g, double g1, const Partials& x) {
    Partials p;
    p.value = g;
    for (std::size_t k = 0; k < N; ++k) p.slope[k] = g1 * x.slope[k];
    return p;
  }
  bool changes() const {
    for (const double s : slope) {
      if (s != 0.0) return true;
    }
    return false;
  }

  friend Partials operator-(const Partials& a) { return chain(-a.value, -1.0, a); }
  friend Partials operator+(const Partials& a, const Partials& b) {
    Partials p;
    p.value = a.value + b.value;
    for (std::size_t k = 0; k < N; ++k) p.slope[k] = a.slope[k] + b.slope[k];
    return p;
  }
  friend Partials operator-(const Partials& a, const Partials& b) {
    Partials p;
    p.value = a.value - b.value;
    for (std::size_t k = 0; k < N; ++k) p.slope[k] = a.slope[k] - b.slope[k];
    return p;
  }
  friend Partials operator*(const Partials& a, const Partials& b) {
    Partials p;
    p.value = a.value * b.value;
    for (std::size_t k = 0; k < N; ++k) p.slope[k] = a.slope[k] * b.value + a.value * b.slope[k];
    return p;
  }
  friend Partials operator/(const Partials& a, const Partials& b) {
    Partials p;
    p.value = a.value / b.value;
    for (std::size_t k = 0; k < N; ++k) p.slope[k] = (a.slope[k] - p.value * b.slope[k]) / b.value;
    return p;
  }
  /// x^n for a constant n; the usual ones by roots and products, which cost a fraction of a power.
  friend Partials pow(const Partials& x, double n) {
    double g = 0.0;
    if (n == 2.0) {
      g = x.value * x.value;
    } else if (n == 1.5) {
      g = x.value * std::sqrt(x.value);
    } else if (n == 0.5) {
      g = std::sqrt(x.value);
    } else {
      g = std::pow(x.value, n);
    }
    const double g1 = n == 0.0 ? 0.0 : x.value == 0.0 ? n * std::pow(x.value, n - 1.0) : n * g / x.value;
    return chain(g, g1, x);
  }
};

}  // namespace freeplay
