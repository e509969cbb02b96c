// Dual: a number with its derivatives by the relative motion of two markers, and vectors of numbers or of duals.
#pragma once

#include <cmath>

#include "freeplay/eigen.h"

namespace freeplay::space {

/// x and dx; the rules of differentiation are those of the operators. Clifford 1873; forward mode.
struct Dual {
  static constexpr int inputs = 15;
  using Gradient = Eigen::Matrix<double, inputs, 1>;

  Dual() = default;
  Dual(double x) : value(x) {}  // a constant
  Dual(double x, const Gradient& g) : value(x), gradient(g) {}
  double value = 0.0;
  Gradient gradient = Gradient::Zero();
};

inline Dual operator-(const Dual& x) { return {-x.value, -x.gradient}; }
inline Dual operator+(const Dual& x, const Dual& y) { return {x.value + y.value, x.gradient + y.gradient}; }
inline Dual operator-(const Dual& x, const Dual& y) { return {x.value - y.value, x.gradient - y.gradient}; }
inline Dual operator*(const Dual& x, const Dual& y) {
  return {x.value * y.value, y.value * x.gradient + x.value * y.gradient};
}
inline Dual operator*(double x, const Dual& y) { return {x * y.value, x * y.gradient}; }
inline Dual operator/(const Dual& x, const Dual& y) {
  const double quotient = x.value / y.value;
  return {quotient, (x.gradient - quotient * y.gradient) / y.value};
}
inline Dual sqrt(const Dual& x) {
  const double root = std::sqrt(x.value);
  return {root, (0.5 / root) * x.gradient};
}
inline Dual atan2(const Dual& y, const Dual& x) {
  const double squared = x.value * x.value + y.value * y.value;
  return {std::atan2(y.value, x.value), (x.value * y.gradient - y.value * x.gradient) / squared};
}

inline double value_of(double x) { return x; }
inline double value_of(const Dual& x) { return x.value; }

/// f(x, y) where `f` and its partial derivatives are known as numbers.
inline double chained(double f, double, double, double, double) { return f; }
inline Dual chained(double f, double by_x, const Dual& x, double by_y, const Dual& y) {
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
