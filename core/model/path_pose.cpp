#include "model/path_pose.h"

#include <cmath>

namespace freeplay {
namespace {

using Quaternion = std::array<Jet, 4>;

template <class Number>
std::array<Number, 4> times(const std::array<Number, 4>& a, const std::array<Number, 4>& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

// 2 a p*, its vector.
Vector3 doubled(const std::array<double, 4>& a, const std::array<double, 4>& p) {
  const std::array<double, 4> r = times(a, {p[0], -p[1], -p[2], -p[3]});
  return {2.0 * r[1], 2.0 * r[2], 2.0 * r[3]};
}

// About axis 1, 2 or 3.
Quaternion about(std::size_t axis, const Jet& angle) {
  const Jet half = Jet::constant(0.5) * angle;
  Quaternion q{};
  q[0] = cos(half);
  q[axis] = sin(half);
  return q;
}

constexpr const char* planar_words[] = {"x", "y", "angle"};
constexpr const char* spatial_words[] = {"x", "y", "z", "roll", "pitch", "yaw"};

}  // namespace

std::span<const char* const> path_words(Space space) {
  return space == Space::planar ? std::span<const char* const>(planar_words) : spatial_words;
}

Turning turning_of(const std::array<Jet, 4>& q) {
  const Jet length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  std::array<double, 4> p{}, rate{}, acceleration{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Jet part = q[i] / length;
    p[i] = part.value;
    rate[i] = part.rate;
    acceleration[i] = part.acceleration;
  }
  const auto [w, x, y, z] = p;
  return {{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),  //
           2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),  //
           2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)},
          doubled(rate, p),
          doubled(acceleration, p)};
}

Turning turning_of(const Jet& roll, const Jet& pitch, const Jet& yaw) {
  return turning_of(times(times(about(3, yaw), about(2, pitch)), about(1, roll)));
}

// w = E (roll', pitch', yaw')^T, alpha = E (...)'' + E' (...)', solved for the rates.
std::array<Jet, 3> roll_pitch_yaw_of(const Turning& turning) {
  const Rotation& r = turning.rotation;
  const double cosine = std::hypot(r[0], r[3]);
  const double roll = std::atan2(r[7], r[8]), pitch = std::atan2(-r[6], cosine), yaw = std::atan2(r[3], r[0]);
  const double cy = std::cos(yaw), sy = std::sin(yaw), tangent = -r[6] / cosine;
  struct Rates {
    double roll, pitch, yaw;
  };
  const auto solved = [&](const Vector3& w) {
    const double along = cy * w[0] + sy * w[1];
    return Rates{along / cosine, cy * w[1] - sy * w[0], w[2] + tangent * along};
  };
  const Rates rate = solved(turning.velocity);
  // What E' makes of the rates.
  const double level = cosine * rate.roll, sunk = -r[6] * rate.roll * rate.pitch;
  const Vector3 rest{-sy * level * rate.yaw - cy * sunk - cy * rate.pitch * rate.yaw,
                     cy * level * rate.yaw - sy * sunk - sy * rate.pitch * rate.yaw, -level * rate.pitch};
  const Vector3& alpha = turning.acceleration;
  const Rates second = solved({alpha[0] - rest[0], alpha[1] - rest[1], alpha[2] - rest[2]});
  return {Jet{roll, rate.roll, second.roll}, Jet{pitch, rate.pitch, second.pitch}, Jet{yaw, rate.yaw, second.yaw}};
}

}  // namespace freeplay
