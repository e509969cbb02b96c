#include "mjcf/pose.h"

#include <fmt/format.h>

#include "mjcf/angles.h"

namespace freeplay::mjcf {
namespace {

/// A zero axis gives no direction: reported.
bool has_length(const Eigen::Vector3d& axis, const Element& element, const char* name, Messages& messages) {
  if (urdf::length_of(axis) > urdf::shortest_direction) return true;
  messages.error(spot_of(element.xml(), name), "bad-urdf",
                 fmt::format("'{}' of {} has zero length: it gives no direction", name, element.owner()));
  return false;
}

Eigen::Matrix3d turn_by_angles(const Eigen::Vector3d& angles, const Settings& settings) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const char letter = settings.euler_axes[static_cast<std::size_t>(i)];
    const bool moves_along = letter >= 'x';
    Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
    rpy[letter - (moves_along ? 'x' : 'X')] = settings.angle_unit * angles[i];
    turn = moves_along ? Eigen::Matrix3d(turn * urdf::rotation(rpy)) : Eigen::Matrix3d(urdf::rotation(rpy) * turn);
  }
  return turn;
}

Eigen::Matrix3d turn_by_axes(const std::vector<double>& numbers, const Element& element, Messages& messages) {
  const Eigen::Vector3d first(numbers[0], numbers[1], numbers[2]);
  if (!has_length(first, element, "xyaxes", messages)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d x = first.normalized(), second(numbers[3], numbers[4], numbers[5]);
  const Eigen::Vector3d y = second - second.dot(x) * x;
  if (!has_length(y, element, "xyaxes", messages)) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d turn;
  turn << x, y.normalized(), x.cross(y.normalized());
  return turn;
}

Eigen::Matrix3d read_turn(Element& element, const Settings& settings, Messages& messages) {
  const std::vector<double> quaternion = element.numbers("quat", 4), axis_angle = element.numbers("axisangle", 4),
                            axes = element.numbers("xyaxes", 6), z = element.numbers("zaxis", 3),
                            angles = element.numbers("euler", 3);
  int ways = 0;
  for (const char* name : {"quat", "axisangle", "xyaxes", "zaxis", "euler"}) {
    if (element.find(name) == nullptr || ++ways < 2) continue;
    messages.error(spot_of(element.xml(), name), "bad-urdf",
                   fmt::format("{} says twice how it is turned, also by '{}'", element.owner(), name), {},
                   "what its class says counts, too");
  }
  if (!quaternion.empty()) {
    return turn_of(quaternion.data(), spot_of(element.xml(), "quat"), element.owner(), messages);
  }
  if (!axis_angle.empty()) {
    const Eigen::Vector3d axis(axis_angle[0], axis_angle[1], axis_angle[2]);
    if (!has_length(axis, element, "axisangle", messages)) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(settings.angle_unit * axis_angle[3], axis.normalized()).toRotationMatrix();
  }
  if (!axes.empty()) return turn_by_axes(axes, element, messages);
  if (!z.empty()) {
    const Eigen::Vector3d axis(z[0], z[1], z[2]);
    return has_length(axis, element, "zaxis", messages) ? turn_to(axis) : Eigen::Matrix3d::Identity();
  }
  if (!angles.empty()) doubt_angles(angles, "euler", element.xml(), element.owner(), settings, messages);
  if (!angles.empty()) return turn_by_angles({angles[0], angles[1], angles[2]}, settings);
  return Eigen::Matrix3d::Identity();
}

}  // namespace

Eigen::Isometry3d read_pose(Element& element, const Settings& settings, Messages& messages) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = element.vector("pos").value_or(Eigen::Vector3d::Zero());
  pose.linear() = read_turn(element, settings, messages);
  return pose;
}

Eigen::Matrix3d turn_of(const double* quaternion, const Spot& spot, const std::string& owner, Messages& messages) {
  const auto turn = urdf::turn_of_quaternion(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
  if (turn) return *turn;
  messages.error(spot, "bad-urdf", fmt::format("the quaternion of {} is zero: it gives no direction", owner));
  return Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d turn_to(const Eigen::Vector3d& axis) { return urdf::least_turn(Eigen::Vector3d::UnitZ(), axis); }

}  // namespace freeplay::mjcf
