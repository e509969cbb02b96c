// SpatialScene: where everything of a spatial model is at one instant, for those who draw it.
#pragma once

#include <span>
#include <vector>

#include "system/joint_freedom.h"
#include "system/system.h"

namespace freeplay {

/// World axes, [m]. The system and `q` must outlive it.
class SpatialScene {
 public:
  using Vector = Eigen::Vector3d;

  SpatialScene(const System& system, std::span<const double> q);

  const Marker& marker(int index) const { return model_.markers[static_cast<std::size_t>(index)]; }
  const JointElement& joint(int index) const { return model_.joints[static_cast<std::size_t>(index)]; }
  const JointFreedom& freedom(int joint) const { return freedoms_[static_cast<std::size_t>(joint)]; }
  /// A frame that every body has.
  static bool is_own(const Marker& frame) { return is_origin(frame) || frame.name.ends_with("/com"); }

  Vector world(const Marker& one) const;
  Eigen::Matrix3d axes_of(const Marker& one) const;
  /// Where a joint moves its second body; of a gear, where its second joint does.
  Vector place(int index) const;
  /// Points of a body, its centre of mass first. One that has no other is a block of its mass and moments, if need be
  /// smaller, so that it does not outgrow the mechanism.
  std::vector<Vector> points_of(BodyId body) const;
  /// Everything that a picture must hold.
  std::vector<Vector> points() const;
  /// Largest size of the mechanism along an axis; 0 where all of it is one point.
  double reach() const { return reach_; }

 private:
  static bool is_origin(const Marker& frame) { return frame.name.ends_with("/origin"); }
  Eigen::Matrix3d turn_of(BodyId body) const;
  Vector centre_of(BodyId body) const;
  MarkerKinematics kinematics(int index) const;
  std::vector<Vector> frames() const;

  const System& system_;
  const Model& model_;
  std::span<const double> q_;
  std::vector<Pose> poses_;  // of the bodies' frames
  std::vector<JointFreedom> freedoms_;
  std::vector<std::vector<int>> markers_;  // of each body
  double reach_ = 0.0;
};

}  // namespace freeplay
