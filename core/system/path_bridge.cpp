#include "system/path_bridge.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include "base/index.h"

namespace freeplay {
namespace {

using Turn = Eigen::Quaterniond;

// p' = w p/2 and p'' = (w' p + w p')/2 with w and w' in world axes.
std::array<Jet, 4> quaternion_of_turning(const Turning& turning) {
  const Turn p(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(turning.rotation.data()).eval());
  const auto half = [](const Vector3& w, const Turn& by) {
    Turn result = Turn(0.0, w[0], w[1], w[2]) * by;
    result.coeffs() *= 0.5;
    return result;
  };
  const Turn rate = half(turning.velocity, p);
  Turn second = half(turning.acceleration, p);
  second.coeffs() += half(turning.velocity, rate).coeffs();
  return {Jet{p.w(), rate.w(), second.w()}, Jet{p.x(), rate.x(), second.x()}, Jet{p.y(), rate.y(), second.y()},
          Jet{p.z(), rate.z(), second.z()}};
}

}  // namespace

Jet quintic(const Jet& a, const Jet& b, double length, double s) {
  const double a1 = length * a.rate, a2 = length * length * a.acceleration;
  const double value = b.value - a.value - a1 - 0.5 * a2, rate = length * b.rate - a1 - a2;
  const double second = length * length * b.acceleration - a2;
  const double c3 = 10.0 * value - 4.0 * rate + 0.5 * second, c4 = -15.0 * value + 7.0 * rate - second;
  const double c5 = 6.0 * value - 3.0 * rate + 0.5 * second;
  return {a.value + s * (a1 + s * (0.5 * a2 + s * (c3 + s * (c4 + s * c5)))),
          (a1 + s * (a2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / length,
          (a2 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (length * length)};
}

PathBridge::PathBridge(End left, End right) : left_(std::move(left)), right_(std::move(right)) {
  for (std::size_t i = 0; i < left_.frames.size(); ++i) {
    left_turns_.push_back(quaternion_of_turning(left_.frames[i].turning));
    right_turns_.push_back(quaternion_of_turning(right_.frames[i].turning));
    double along = 0.0;
    for (std::size_t k = 0; k < 4; ++k) along += left_turns_[i][k].value * right_turns_[i][k].value;
    if (along >= 0.0) continue;
    for (Jet& part : right_turns_[i]) part = -part;
  }
}

Jet PathBridge::driver(std::size_t index, double t) const {
  return quintic(left_.drivers[index], right_.drivers[index], right_.t - left_.t, part(t));
}

void PathBridge::frame(std::size_t index, double t, bool spatial, PathPose& pose) const {
  const double length = right_.t - left_.t, s = part(t);
  for (std::size_t i = 0; i < 3; ++i) {
    pose[i] = quintic(left_.frames[index][i], right_.frames[index][i], length, s);
  }
  if (!spatial) return;
  Quaternion turn;
  for (std::size_t k = 0; k < 4; ++k) {
    turn[k] = quintic(left_turns_[index][k], right_turns_[index][k], length, s);
  }
  pose.turning = turning_of(turn);
  const std::array<Jet, 3> angles = roll_pitch_yaw_of(pose.turning);
  std::ranges::copy(angles, pose.numbers.begin() + 3);
}

}  // namespace freeplay
