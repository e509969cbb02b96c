// Directions and turns that robot files write: what of Eigen takes long to compile stands in one unit.
#pragma once

#include <optional>

#include <Eigen/Geometry>

namespace freeplay::urdf {

/// Below it a vector gives no direction, whatever its unit.
inline constexpr double shortest_direction = 1e-12;

/// Also of vectors whose squares overflow.
double length_of(const Eigen::Vector3d& v);

/// The rotation of a quaternion of any length, none if that is below shortest_direction.
std::optional<Eigen::Matrix3d> turn_of_quaternion(double w, double x, double y, double z);

/// The pose of the first frame in the second, from that of the second in the first.
Eigen::Isometry3d inverse_pose(const Eigen::Isometry3d& pose);

/// The least rotation that takes the direction `from` to that of `to`; both have a length.
Eigen::Matrix3d least_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// A symmetric tensor by its principal values, which rise, and its axes, the columns.
struct PrincipalTensor {
  Eigen::Vector3d values;
  Eigen::Matrix3d axes;
};
PrincipalTensor principal(const Eigen::Matrix3d& tensor);

}  // namespace freeplay::urdf
