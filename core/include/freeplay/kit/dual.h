// Dual: a number with its derivatives by the relative motion of two markers, and vectors of numbers or of duals.
#pragma once

#include <cmath>

#include "freeplay/eigen.h"

namespace freeplay::space {

/// x and dx by N inputs; the rules of differentiation are those of the operators. Clifford 1873; forward mode.
template <int N>
struct DualBy {
  static constexpr int inputs = N;
  using Gradient = Eigen::Matrix<double, inputs, 1>;

  DualBy() = default;
  DualBy(double x) : value(x) {}  // a constant
  DualBy(double x, const Gradient& g) : value(x), gradient(g) {}
  double value = 0.0;
  Gradient gradient = Gradient::Zero();

  friend DualBy operator-(const DualBy& x) { return {-x.value, -x.gradient}; }
  friend DualBy operator+(const DualBy& x, const DualBy& y) { return {x.value + y.value, x.gradient + y.gradient}; }
  friend DualBy operator-(const DualBy& x, const DualBy& y) { return {x.value - y.value, x.gradient - y.gradient}; }
  friend DualBy operator*(const DualBy& x, const DualBy& y) {
    return {x.value * y.value, y.value * x.gradient + x.value * y.gradient};
  }
  friend DualBy operator*(double x, const DualBy& y) { return {x * y.value, x * y.gradient}; }
  friend DualBy operator/(const DualBy& x, const DualBy& y) {
    const double quotient = x.value / y.value;
    return {quotient, (x.gradient - quotient * y.gradient) / y.value};
  }
  friend DualBy sqrt(const DualBy& x) {
    const double root = std::sqrt(x.value);
    return {root, (0.5 / root) * x.gradient};
  }
  friend DualBy atan2(const DualBy& y, const DualBy& x) {
    const double squared = x.value * x.value + y.value * y.value;
    return {std::atan2(y.value, x.value), (x.value * y.gradient - y.value * x.gradient) / squared};
  }
};
/// By the 15 numbers of the relative motion of two markers in space.
using Dual = DualBy<15>;

inline double value_of(double x) { return x; }
template <int N>
double value_of(const DualBy<N>& x) {
  return x.value;
}

/// f(x, y) where `f` and its partial derivatives are known as numbers.
inline double chained(double f, double, double, double, double) { return f; }
template <int N>
DualBy<N> chained(double f, double by_x, const DualBy<N>& x, double by_y, const DualBy<N>& y) {
  return {f, by_x * x.gradient + by_y * y.gradient};
}

template <class T>
struct Vec {
  T x{}, y{}, z{};
};
template <class T>
Vec<T> operator-(const Vec<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
Vec<T> operator+(const Vec<T>& a, const Vec<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Vec<T> operator-(const Vec<T>& a, const Vec<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Vec<T> operator*(const T& k, const Vec<T>& a) {
  return {k * a.x, k * a.y, k * a.z};
}
template <class T>
T dot(const Vec<T>& a, const Vec<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace freeplay::space
