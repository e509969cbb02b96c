// BodyCoordinates: poses and twists of bodies in the coordinates q and the velocities v.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/model.h"
#include "system/spatial_bodies.h"

namespace freeplay {

/// In the plane q has x, y [m] and the angle [rad] of each body, v their rates. In space q has the position of the
/// centre of mass [m] and the unit quaternion w x y z of the principal axes, v the velocity [m/s] and the angular
/// velocity in principal axes [rad/s].
class BodyCoordinates {
 public:
  explicit BodyCoordinates(const Model& model);

  /// Whether an entry of v is the rate of an angle [rad/s], not of a length.
  bool is_turn(int velocity) const { return model_.space == Space::planar ? velocity % 3 == 2 : velocity % 6 >= 3; }
  /// q <- base + increment: rotations in space turn by the increment's rotation vector in principal axes.
  void retract(std::span<const double> base, std::span<const double> increment, std::span<double> q) const;
  /// The increment that leads from `base` to `q`.
  void difference(std::span<const double> base, std::span<const double> q, std::span<double> increment) const;
  /// Rate of an increment at the velocities v where it has led to; and the velocities for its rate. The same numbers in
  /// the plane.
  void increment_rate(std::span<const double> increment, std::span<const double> v, std::span<double> rate) const;
  void velocities_of(std::span<const double> increment, std::span<const double> rate, std::span<double> v) const;
  /// Pose of a body's frame in the world, and the coordinates for one.
  Pose frame_pose(BodyId body, std::span<const double> q) const;
  void set_frame_pose(BodyId body, const Pose& pose, std::span<double> q) const;
  /// Unit quaternion w x y z of a body's frame; spatial models.
  std::array<double, 4> frame_quaternion(BodyId body, std::span<const double> q) const;
  /// Velocity of a body's centre of mass and its angular velocity [m/s, rad/s], 6 numbers in world axes; and v for it.
  void body_twist(BodyId body, std::span<const double> q, std::span<const double> v, double* twist) const;
  void set_body_twist(BodyId body, std::span<const double> q, const double* twist, std::span<double> v) const;
  /// Axes of a body from its principal axes, right-handed, and its moments of inertia about them [kg m^2]; spatial
  /// models.
  const spatial::Matrix& principal_axes(BodyId body) const { return principal_[static_cast<std::size_t>(body)]; }
  const spatial::Vector& principal_moments(BodyId body) const { return moments_[static_cast<std::size_t>(body)]; }

 private:
  const Model& model_;
  std::vector<spatial::Matrix> principal_;
  std::vector<spatial::Vector> moments_;
};

}  // namespace freeplay
