// UrdfView: a robot as the bodies and frames of a plane or of space, in values of a model file.
#pragma once

#include <memory>

#include "urdf/nodes.h"
#include "urdf/plane.h"

namespace freeplay::urdf {

enum class Side { parent, child };

/// What depends on the space in which a robot is seen. Null: the model's default says the same.
class View {
 public:
  virtual ~View() = default;

  /// Of a link that is a body, with what is part of it.
  virtual double mass(int link) const = 0;
  virtual const Node& inertia(int link) = 0;
  virtual const Node* com(int link) = 0;
  /// Of a body at coordinates zero, in the root frame.
  virtual const Node& pose(int link) = 0;

  /// Of a link that is part of a body, in that body.
  virtual const Node& link_frame(int link) = 0;
  /// Of a joint, in the body on that side.
  virtual const Node& joint_frame(int joint, Side side) = 0;
  /// Of a joint with a coordinate, in the body on that side: the joint's frame turned so that its x axis, if the joint
  /// slides, or z axis, if it turns, is that of the joint. Null: the joint's frame stands so.
  virtual const Node* axis_frame(int joint, Side side) = 0;
  /// Of a slide: the joint's frame in the parent, moved back along the axis by `distance` [m].
  virtual const Node& set_back(int joint, double distance) = 0;
  /// The joint's `axis`.
  virtual const Node* axis(int joint) = 0;
  /// Of the joint's coordinate against the one of the file.
  virtual double sign(int joint) const = 0;
};

std::unique_ptr<View> planar_view(const Robot& robot, const PlanarRobot& planar, Nodes& nodes);
std::unique_ptr<View> spatial_view(const Robot& robot, Nodes& nodes);

}  // namespace freeplay::urdf
