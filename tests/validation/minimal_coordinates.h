// Pendulums in minimal coordinates, integrated to rounding: references that share nothing with the program.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace freeplay::test {

/// Motion of one or two uniform rods of 1 m and 1 kg that hang in a chain from the origin; absolute angles from +x,
/// start at rest, gravity 9.81 along -y. Classic Runge-Kutta of order 4 in long double.
template <std::size_t N>
class RodChain {
 public:
  using Vector = std::array<long double, N>;
  struct Instant {
    Vector angle, rate, acceleration;
  };

  /// States at k * interval for k = 0 to count. The error is below 1e-13 with steps of 1e-4 s.
  static std::vector<Instant> integrate(const Vector& start, double interval, int count) {
    const int steps = static_cast<int>(std::lround(interval / 1e-4));
    const long double h = static_cast<long double>(interval) / steps;
    Instant now{start, {}, {}};
    now.acceleration = accelerations(now.angle, now.rate);
    std::vector<Instant> all{now};
    for (int k = 0; k < count; ++k) {
      for (int i = 0; i < steps; ++i) now = step(now, h);
      now.acceleration = accelerations(now.angle, now.rate);
      all.push_back(now);
    }
    return all;
  }

 private:
  static constexpr long double g = 9.81L;

  static Vector accelerations(const Vector& q, const Vector& w) {
    if constexpr (N == 1) {
      return {-1.5L * g * std::cos(q[0])};  // (1/3) m l^2 q'' = -m g (l/2) cos q
    } else {
      // (4/3) q1'' + c/2 q2'' = -s/2 q2'^2 - (3/2) g cos q1,  c/2 q1'' + (1/3) q2'' = s/2 q1'^2 - (1/2) g cos q2
      const long double c = std::cos(q[0] - q[1]), s = std::sin(q[0] - q[1]);
      const long double a = 4.0L / 3.0L, b = 0.5L * c, d = 1.0L / 3.0L;
      const long double e = -0.5L * s * w[1] * w[1] - 1.5L * g * std::cos(q[0]);
      const long double f = 0.5L * s * w[0] * w[0] - 0.5L * g * std::cos(q[1]);
      const long double determinant = a * d - b * b;
      return {(e * d - b * f) / determinant, (a * f - b * e) / determinant};
    }
  }
  static Vector moved(const Vector& x, long double h, const Vector& rate) {
    Vector y = x;
    for (std::size_t i = 0; i < N; ++i) y[i] += h * rate[i];
    return y;
  }
  static Instant step(const Instant& n, long double h) {
    const Vector a1 = accelerations(n.angle, n.rate);
    const Vector v2 = moved(n.rate, 0.5L * h, a1), a2 = accelerations(moved(n.angle, 0.5L * h, n.rate), v2);
    const Vector v3 = moved(n.rate, 0.5L * h, a2), a3 = accelerations(moved(n.angle, 0.5L * h, v2), v3);
    const Vector v4 = moved(n.rate, h, a3), a4 = accelerations(moved(n.angle, h, v3), v4);
    Instant next = n;
    for (std::size_t i = 0; i < N; ++i) {
      next.angle[i] += h / 6.0L * (n.rate[i] + 2.0L * v2[i] + 2.0L * v3[i] + v4[i]);
      next.rate[i] += h / 6.0L * (a1[i] + 2.0L * a2[i] + 2.0L * a3[i] + a4[i]);
    }
    return next;
  }
};

}  // namespace freeplay::test
