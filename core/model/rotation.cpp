#include "model/rotation.h"

#include <algorithm>
#include <cmath>

namespace freeplay {

Rotation product(const Rotation& a, const Rotation& b) {
  Rotation out{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 3; ++i) out[3 * r + c] += a[3 * r + i] * b[3 * i + c];
    }
  }
  return out;
}

Rotation from_roll_pitch_yaw(double roll, double pitch, double yaw) {
  const double cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch);
  const double cy = std::cos(yaw), sy = std::sin(yaw);
  return {cy * cp,
          cy * sp * sr - sy * cr,
          cy * sp * cr + sy * sr,
          sy * cp,
          sy * sp * sr + cy * cr,
          sy * sp * cr - cy * sr,
          -sp,
          cp * sr,
          cp * cr};
}

Rotation least_rotation(const Vector3& from, const Vector3& to) {
  const Vector3 n{from[1] * to[2] - from[2] * to[1], from[2] * to[0] - from[0] * to[2],
                  from[0] * to[1] - from[1] * to[0]};
  const double cosine = from[0] * to[0] + from[1] * to[1] + from[2] * to[2];
  if (cosine < -1.0 + 1e-12) {
    // About the world axis that is farthest from both.
    std::size_t least = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (std::abs(from[i]) < std::abs(from[least])) least = i;
    }
    Vector3 u{};
    u[least] = 1.0;
    for (std::size_t i = 0; i < 3; ++i) u[i] -= from[least] * from[i];
    const double size = std::hypot(u[0], u[1], u[2]);
    Rotation half{};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) half[3 * r + c] = 2.0 * u[r] * u[c] / (size * size) - (r == c ? 1.0 : 0.0);
    }
    return half;
  }
  // I + [n] + [n]^2/(1 + cos)
  const Rotation k{0.0, -n[2], n[1], n[2], 0.0, -n[0], -n[1], n[0], 0.0};
  const Rotation square = product(k, k);
  Rotation out = no_rotation;
  for (std::size_t i = 0; i < 9; ++i) out[i] += k[i] + square[i] / (1.0 + cosine);
  return out;
}

// Jacobi's rotations: exact to rounding, whatever the size of the numbers.
Vector3 principal_moments(const Rotation& tensor) {
  Rotation m = tensor;
  constexpr std::size_t pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (int sweep = 0; sweep < 30; ++sweep) {
    for (const auto& [p, q] : pairs) {
      const double off = m[3 * p + q];
      if (off == 0.0) continue;
      const double theta = 0.5 * (m[3 * q + q] - m[3 * p + p]) / off;
      const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
      const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
      Rotation turn = no_rotation;
      turn[3 * p + p] = turn[3 * q + q] = c;
      turn[3 * p + q] = s;
      turn[3 * q + p] = -s;
      Rotation transposed = turn;
      std::swap(transposed[3 * p + q], transposed[3 * q + p]);
      m = product(product(transposed, m), turn);
      m[3 * p + q] = m[3 * q + p] = 0.0;
    }
  }
  Vector3 moments{m[0], m[4], m[8]};
  std::ranges::sort(moments);
  return moments;
}

}  // namespace freeplay
