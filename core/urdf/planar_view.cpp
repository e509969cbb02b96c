#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "urdf/mass.h"
#include "urdf/view.h"

namespace freeplay::urdf {
namespace {

class PlanarView final : public View {
 public:
  PlanarView(const Robot& robot, const PlanarRobot& planar, Nodes& nodes)
      : robot_(robot),
        planar_(planar),
        nodes_(nodes),
        axes_(plane_axes(planar.plane)),
        bodies_(body_masses(robot, planar.mounts)) {}

  double mass(int link) const override { return bodies_[at(link)].mass; }
  const Node& inertia(int link) override {
    const Eigen::Vector3d normal = axes_.row(2);
    const double moment = normal.dot(bodies_[at(link)].inertia * normal);
    return nodes_.number(std::max(0.0, moment), robot_.links[at(link)].inertia_spot);
  }
  const Node* com(int link) override {
    const Eigen::Vector3d com = axes_ * bodies_[at(link)].com;
    if (com[0] == 0.0 && com[1] == 0.0) return nullptr;
    return &nodes_.numbers({com[0] + 0.0, com[1] + 0.0}, robot_.links[at(link)].mass_spot);
  }
  const Node& pose(int link) override {
    const Spot& spot = robot_.links[at(link)].spot;
    const PlanarPose& pose = planar_.poses[at(link)];
    Node& value = nodes_.map(spot);
    nodes_.put(value, "position", nodes_.numbers({pose.x, pose.y}, spot), spot);
    nodes_.put(value, "angle", nodes_.number(pose.angle, spot), spot);
    return value;
  }

  const Node& link_frame(int link) override { return frame(planar_.frames[at(link)], robot_.links[at(link)].spot); }
  const Node& joint_frame(int joint, Side side) override {
    const PlanarJoint& seen = planar_.joints[at(joint)];
    return frame(side == Side::parent ? seen.first : seen.second, robot_.joints[at(joint)].spot);
  }
  const Node* axis_frame(int, Side) override { return nullptr; }
  const Node& set_back(int joint, double distance) override {
    PlanarPose pose = planar_.joints[at(joint)].first;
    pose.x -= distance * std::cos(pose.angle);
    pose.y -= distance * std::sin(pose.angle);
    return frame(pose, robot_.joints[at(joint)].damping_spot);
  }
  const Node* axis(int) override { return nullptr; }
  double sign(int joint) const override { return planar_.joints[at(joint)].sign; }

 private:
  const Node& frame(const PlanarPose& pose, const Spot& spot) {
    Node& position = nodes_.numbers({pose.x, pose.y}, spot);
    if (pose.angle == 0.0) return position;
    Node& frame = nodes_.map(spot);
    nodes_.put(frame, "position", position, spot);
    nodes_.put(frame, "angle", nodes_.number(pose.angle, spot), spot);
    return frame;
  }

  const Robot& robot_;
  const PlanarRobot& planar_;
  Nodes& nodes_;
  Eigen::Matrix3d axes_;
  std::vector<MassProperties> bodies_;
};

}  // namespace

std::unique_ptr<View> planar_view(const Robot& robot, const PlanarRobot& planar, Nodes& nodes) {
  return std::make_unique<PlanarView>(robot, planar, nodes);
}

}  // namespace freeplay::urdf
