#include "base/index.h"
#include "urdf/mass.h"
#include "urdf/view.h"

namespace freeplay::urdf {
namespace {

class SpatialView final : public View {
 public:
  SpatialView(const Robot& robot, Nodes& nodes)
      : robot_(robot), nodes_(nodes), bodies_(body_masses(robot, robot.mounts)), poses_(robot.links.size()) {
    for (const int link : robot.order) place(link);
    for (const Joint& joint : robot.joints) joints_.push_back(seen(joint));
  }

  double mass(int link) const override { return bodies_[at(link)].mass; }
  const Node& inertia(int link) override {
    const Eigen::Matrix3d& i = bodies_[at(link)].inertia;
    std::vector<double> values{i(0, 0), i(1, 1), i(2, 2)};
    if (i(0, 1) != 0.0 || i(0, 2) != 0.0 || i(1, 2) != 0.0) {
      values.insert(values.end(), {i(0, 1) + 0.0, i(0, 2) + 0.0, i(1, 2) + 0.0});
    }
    return nodes_.numbers(values, robot_.links[at(link)].inertia_spot);
  }
  const Node* com(int link) override {
    const Eigen::Vector3d& com = bodies_[at(link)].com;
    return com.isZero(0.0) ? nullptr : &vector(com, robot_.links[at(link)].mass_spot);
  }
  const Node& pose(int link) override {
    const Spot& spot = robot_.links[at(link)].spot;
    Node& value = nodes_.map(spot);
    nodes_.put(value, "position", vector(poses_[at(link)].translation(), spot), spot);
    nodes_.put(value, "quaternion", quaternion(poses_[at(link)].linear(), spot), spot);
    return value;
  }

  const Node& link_frame(int link) override { return frame(robot_.mounts[at(link)].pose, robot_.links[at(link)].spot); }
  const Node& joint_frame(int joint, Side side) override {
    return frame(end(joint, side), robot_.joints[at(joint)].spot);
  }
  const Node* axis_frame(int joint, Side side) override {
    const Joint& source = robot_.joints[at(joint)];
    const Eigen::Vector3d own = own_axis(source.type), &axis = joints_[at(joint)].axis;
    if (axis == own) return nullptr;
    Eigen::Isometry3d turned = end(joint, side);
    turned.linear() = turned.linear() * least_turn(own, axis);
    return &frame(turned, source.spot);
  }
  const Node& set_back(int joint, double distance) override {
    Eigen::Isometry3d pose = joints_[at(joint)].first;
    pose.translation() -= distance * (pose.linear() * joints_[at(joint)].axis);
    return frame(pose, robot_.joints[at(joint)].damping_spot);
  }
  const Node* axis(int joint) override {
    const Joint& source = robot_.joints[at(joint)];
    if (!source.has_axis() || joints_[at(joint)].axis == own_axis(source.type)) return nullptr;
    return &vector(joints_[at(joint)].axis, source.axis_spot);
  }
  double sign(int) const override { return 1.0; }

 private:
  /// A joint between bodies: its frames in them, and its axis in both frames.
  struct Seen {
    Eigen::Isometry3d first = Eigen::Isometry3d::Identity(), second = Eigen::Isometry3d::Identity();
    Eigen::Vector3d axis;
  };

  static Eigen::Vector3d own_axis(JointType type) {
    return type == JointType::prismatic ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
  }

  const Mount& mount(int link) const { return link < 0 ? world_ : robot_.mounts[at(link)]; }
  /// At coordinates zero, in the root frame, of the body that carries the link.
  Eigen::Isometry3d body_pose(int link) const {
    const int body = mount(link).body;
    return body == world_link ? Eigen::Isometry3d::Identity() : poses_[at(body)];
  }

  void place(int link) {
    poses_[at(link)].setIdentity();
    const int parent = robot_.parent_joint[at(link)];
    if (parent < 0) return;
    const Joint& joint = robot_.joints[at(parent)];
    poses_[at(link)] = poses_[at(joint.parent.link)] * joint.child_pose();
  }

  Seen seen(const Joint& joint) const {
    Seen out{mount(joint.parent.link).pose * joint.parent.frame, mount(joint.child.link).pose * joint.child.frame,
             joint.axis};
    if (!joint.closed_at_zero) return out;
    // The parent's frame stands where the child's is when all coordinates are zero.
    const Eigen::Isometry3d zero = body_pose(joint.child.link) * out.second;
    out.first = inverse_pose(body_pose(joint.parent.link)) * zero;
    if (joint.axis_in_world) out.axis = zero.linear().transpose() * joint.axis;
    return out;
  }

  const Eigen::Isometry3d& end(int joint, Side side) const {
    return side == Side::parent ? joints_[at(joint)].first : joints_[at(joint)].second;
  }

  const Node& vector(const Eigen::Vector3d& v, const Spot& spot) {
    return nodes_.numbers({v[0] + 0.0, v[1] + 0.0, v[2] + 0.0}, spot);
  }
  const Node& quaternion(const Eigen::Matrix3d& rotation, const Spot& spot) {
    const Eigen::Quaterniond q(rotation);
    return nodes_.numbers({q.w(), q.x() + 0.0, q.y() + 0.0, q.z() + 0.0}, spot);
  }
  const Node& frame(const Eigen::Isometry3d& pose, const Spot& spot) {
    const Node& position = vector(pose.translation(), spot);
    if (pose.linear().isIdentity(0.0)) return position;
    Node& frame = nodes_.map(spot);
    nodes_.put(frame, "position", position, spot);
    nodes_.put(frame, "quaternion", quaternion(pose.linear(), spot), spot);
    return frame;
  }

  const Robot& robot_;
  const Mount world_;
  Nodes& nodes_;
  std::vector<MassProperties> bodies_;
  std::vector<Eigen::Isometry3d> poses_;  ///< of each link's frame at coordinates zero, in the root frame
  std::vector<Seen> joints_;
};

}  // namespace

std::unique_ptr<View> spatial_view(const Robot& robot, Nodes& nodes) {
  return std::make_unique<SpatialView>(robot, nodes);
}

}  // namespace freeplay::urdf
