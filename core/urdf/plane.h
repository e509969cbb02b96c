// UrdfPlane: a robot whose joints all move in one plane, seen in that plane.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "urdf/element.h"

namespace freeplay::urdf {

/// Axes and angles this far [rad] out of the plane are taken for rounded ones and snapped.
inline constexpr double planar_tolerance = 1e-5;

struct PlanarPose {
  double x = 0.0, y = 0.0, angle = 0.0;  ///< [m], [rad]
};

/// A joint between two bodies (or ground) of the plane. Both poses are in body frames; x of a slide's runs along it.
struct PlanarJoint {
  PlanarPose first, second;
  double sign = 1.0;      ///< of the planar coordinate against the one of the file: -1 for an axis against the normal
  double residual = 0.0;  ///< how far it is out of the plane [rad]
  std::string fault;      ///< which direction that is, "" when within the tolerance
  Spot spot;              ///< of that direction
};

/// The plane: rows are its x axis, its y axis and its normal, in the axes of the root link. xy: x y z; xz: x z -y;
/// yz: y z x.
Eigen::Matrix3d plane_axes(Options::Plane plane);
const char* plane_word(Options::Plane plane);

struct PlanarRobot {
  Options::Plane plane = Options::Plane::xy;
  std::vector<PlanarJoint> joints;         ///< of each joint of the robot, also those that tie a mere frame
  std::vector<PlanarPose> frames;          ///< of each link in the frame of its body
  std::vector<std::string> tilted_frames;  ///< links whose frames stand out of the plane
  std::vector<Mount> mounts;               ///< of each link, in the frame of a body that stands upright
  std::vector<PlanarPose> poses;           ///< of each link at coordinates zero, in the root frame
  bool planar() const;
};

/// The robot in that plane. A body whose link frame is tilted, but moves in the plane, has an upright frame instead:
/// the same origin, x along the first axis of the link, in the order of the plane's, that lies in the plane. Each joint
/// is snapped by itself, so that rounded angles do not add up along a chain.
PlanarRobot project(const Robot& robot, Options::Plane plane);

/// Reports each joint that does not move in the plane with its residual: `urdf-not-planar`.
void report_not_planar(const Robot& robot, const PlanarRobot& seen, Messages& messages);

}  // namespace freeplay::urdf
