// SdfScene: what an SDFormat file declares, as it is written.
#pragma once

#include <optional>
#include <vector>

#include "sdf/frames.h"

namespace freeplay::sdf {

struct SceneLink {
  urdf::Link link;
  int frame = 0;
  bool is_static = false;
};

struct SceneAxis {
  bool given = false;
  Eigen::Vector3d xyz = Eigen::Vector3d::UnitZ();
  Frame::Name expressed_in;  ///< empty: the joint's own frame
  Spot spot;
};

struct SceneJoint {
  /// A gear is no joint of the robot but ties two of them.
  enum class Kind { plain, universal, screw, gear };
  Kind kind = Kind::plain;
  urdf::Joint joint;  ///< all but its frames and axes
  int frame = 0;
  Frame::Name parent, child;
  SceneAxis axis, second;
  double ratio = 1.0;     ///< of a gear
  Frame::Name reference;  ///< body from which a gear's angles count
};

struct Scene {
  explicit Scene(Messages& messages) : frames(messages) {}

  Frames frames;
  std::vector<SceneLink> links;
  std::vector<SceneJoint> joints;
  Eigen::Vector3d gravity{0.0, 0.0, -9.8};  ///< SDFormat's own
  Spot gravity_spot, spot;
  int minor = 12;  ///< version 1.minor
  int touching = 0;

  /// From 1.7 on all frames of a scope have names of their own, and poses may name them.
  bool names_frames() const { return minor >= 7; }
};

/// Reads the world of the file, or its models.
void read_scene(XmlElement& root, Scene& scene, Messages& messages);

/// Reads a link or joint that is declared in the model `scope`.
void read_link(XmlElement& xml, int scope, bool is_static, Scene& scene, Messages& messages);
void read_joint(XmlElement& xml, int scope, Scene& scene, Messages& messages);

/// Reads the `pose` of an element into its frame; `names` is false where it may name no other one.
void read_pose(Element& element, Frame& frame, bool names, const Scene& scene, Messages& messages);
/// The name of an element and its place, which is required.
Frame::Name read_name(Element& element, Messages& messages);

/// Values of children of an element; `standard` where there is none or after a message. `spot` becomes the value's
/// place where there is one.
double read_value(Element& element, const char* name, double standard, Messages& messages, Spot* spot = nullptr);
bool read_flag(Element& element, const char* name, bool standard, Messages& messages);
Frame::Name read_word(Element& element, const char* name, bool required, Messages& messages);

/// The scene as a robot, whose first link is the world. After a message parts of it are missing.
urdf::Robot robot_of(Scene& scene, Messages& messages);

}  // namespace freeplay::sdf
