// UrdfRobot: what a robot file says, URDF or another, checked piece by piece, with the places where it says it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "urdf/direction.h"

namespace freeplay::urdf {

/// Place of a piece of the file, for messages: line and column from 1, width of the caret line.
struct Spot {
  int line = 1, column = 1, length = 1;
};

/// How the file is to be read: the keys of section 13 of the model format.
struct Options {
  enum class Space { planar, spatial, by_robot };  ///< by_robot: planar where it is, else spatial
  enum class Plane { xy, xz, yz };
  Space space = Space::planar;
  std::optional<Plane> plane = Plane::xy;  ///< empty: the first in which the robot is planar
  bool floating_base = false;
  bool two_parents = false;     ///< a later joint to a link that has a parent closes a loop
  bool repair_inertia = false;  ///< mend impossible inertia
  bool merge_fixed = false;     ///< bodies on fixed joints become part of what carries them
  bool stops = false;           ///< joint limits become stops
};

struct Link {
  std::string name;
  Spot spot, element;  ///< of the name and of the element
  bool has_inertial = false;
  double mass = 0.0;  ///< [kg]
  Spot mass_spot;
  Eigen::Isometry3d inertial = Eigen::Isometry3d::Identity();  ///< frame of the inertia at the centre of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();           ///< in that frame [kg m^2]
  bool inertia_known = true;      ///< false after a message about its numbers or its origin
  std::array<Spot, 3> moments{};  ///< of ixx, iyy, izz
  Spot inertia_spot;

  bool has_mass() const { return has_inertial && mass > 0.0; }
};

inline constexpr int no_link = -2, world_link = -1;

/// One side of a joint.
struct End {
  int link = no_link;                                       ///< index into Robot::links, or world_link
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();  ///< of the joint, in the link frame
  Spot spot, frame_spot;                                    ///< of the link's name and of the origin
};

/// URDF has the first five. Frames of a universal joint have the axis of the parent as x and that of the child as y,
/// those of a cylindrical one and of a screw its axis as z.
enum class JointType { revolute, prismatic, fixed, floating, planar, spherical, universal, cylindrical, screw };

struct Mimic {
  std::string joint;  ///< the leading one
  int index = -1;     ///< in Robot::joints
  double multiplier = 1.0, offset = 0.0;
  Spot spot, multiplier_spot, offset_spot;
};

struct Limits {
  double lower = 0.0, upper = 0.0;  ///< [rad or m]
  double effort = 0.0;              ///< the largest that drives the joint [N m or N]
  Spot spot;
  double stiffness = 0.0;  ///< of the stops [N m/rad or N/m]; 0: the file says none
};

/// A slide without limits: a spring or damper acts along the line to a point of the slide's axis that is a bit further
/// away than this [m].
inline constexpr double endless_reach = 999.0;

/// A joint of the tree or one that closes a loop. Both frames coincide at coordinate zero, but for what the joint
/// frees.
struct Joint {
  std::string name;
  Spot spot, element;  ///< of the name and of the element
  JointType type = JointType::fixed;
  Spot type_spot;
  End parent, child;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit vector in the joint frame
  Spot axis_spot;
  bool axis_given = false;
  double damping = 0.0;  ///< [N m s/rad or N s/m]
  Spot damping_spot;
  double friction = 0.0;  ///< [N m or N]
  Spot friction_spot;
  double stiffness = 0.0;  ///< of a spring [N m/rad or N/m]
  double slack_at = 0.0;   ///< coordinate at which it is slack [rad or m]
  Spot stiffness_spot;
  double lead = 0.0;  ///< of a screw [m]
  std::optional<Limits> limits;
  double reach = 0.0;  ///< of a slide: the larger limit [m]
  std::optional<Mimic> mimic;
  bool closes_loop = false;
  bool closed_at_zero = false;  ///< the parent's frame stands where the child's is when all coordinates are zero
  bool axis_in_world = false;   ///< with closed_at_zero: `axis` is in axes of the root link

  /// Of the child's frame in that of the parent, at coordinate zero.
  Eigen::Isometry3d child_pose() const { return parent.frame * inverse_pose(child.frame); }
  bool moves() const { return type != JointType::fixed; }
  bool turns() const { return type == JointType::revolute; }
  /// Has it freedoms that only a spatial model knows?
  bool is_spatial() const {
    return type == JointType::spherical || type == JointType::universal || type == JointType::cylindrical ||
           type == JointType::screw;
  }
  bool has_coordinate() const { return type == JointType::revolute || type == JointType::prismatic; }
  bool has_axis() const { return has_coordinate() || type == JointType::planar; }
};

/// What hangs where: filled by build_tree().
struct Mount {
  int body = world_link;                                   ///< the link that carries this one, perhaps itself
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the link frame in that body's frame
};

struct Robot {
  Spot spot;
  std::vector<Link> links;
  std::vector<Joint> joints;  ///< in file order, those of the tree first
  bool places_known = true;   ///< false after a message about the place, type or axis of a joint: a guess stands there
  std::optional<Eigen::Vector3d> gravity;  ///< empty: the file says none [m/s^2]
  Spot gravity_spot;
  bool ambiguous = false;  ///< a link was named twice, or a joint names none: the tree is not determined

  // Filled by build_tree().
  int root = no_link;
  std::vector<int> parent_joint;  ///< of each link; -1 for the root
  std::vector<int> order;         ///< links, each after its parent
  std::vector<Mount> mounts;      ///< of each link
};

}  // namespace freeplay::urdf
