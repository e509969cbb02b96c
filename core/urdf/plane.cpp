#include "urdf/plane.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/angle.h"
#include "base/index.h"

namespace freeplay::urdf {
namespace {

/// A frame with the axes of the plane: x, y, normal.
struct Frame {
  Eigen::Matrix3d turn;
  Eigen::Vector3d offset;
};

Frame seen(const Eigen::Isometry3d& pose, const Eigen::Matrix3d& axes) {
  return {axes * pose.linear() * axes.transpose(), axes * pose.translation()};
}

/// Angle between the normals of a frame and of the plane.
double tilt(const Eigen::Matrix3d& turn) { return std::atan2(std::hypot(turn(0, 2), turn(1, 2)), turn(2, 2)); }

double clean(double value) { return value + 0.0; }  // no -0

PlanarPose flat(const Frame& frame) {
  const bool upright = tilt(frame.turn) <= planar_tolerance;
  return {clean(frame.offset[0]), clean(frame.offset[1]),
          upright ? clean(std::atan2(frame.turn(1, 0), frame.turn(0, 0))) : 0.0};
}

PlanarPose operator*(const PlanarPose& a, const PlanarPose& b) {
  const double c = std::cos(a.angle), s = std::sin(a.angle);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, a.angle + b.angle};
}

PlanarPose inverse(const PlanarPose& a) {
  const double c = std::cos(a.angle), s = std::sin(a.angle);
  return {clean(-c * a.x - s * a.y), clean(s * a.x - c * a.y), clean(-a.angle)};
}

/// How far `axis` is from the normal, either way, or from the plane.
double off_normal(const Eigen::Vector3d& axis) { return std::atan2(std::hypot(axis[0], axis[1]), std::abs(axis[2])); }
double off_plane(const Eigen::Vector3d& axis) { return std::atan2(std::abs(axis[2]), std::hypot(axis[0], axis[1])); }

/// Turns a tilted joint frame upright: `turn` times the result has the plane's normal as third axis. Taken from the
/// joint's own numbers, so that rounded right angles do not add up along a chain: the normal is the axis of a pin, else
/// the axis of the frame that comes near it; x is the first axis of the frame that lies in the plane. Identity for a
/// frame that is upright already, or whose joint does not move in the plane.
Eigen::Matrix3d upright(const Eigen::Matrix3d& turn, const Eigen::Vector3d& axis, JointType type) {
  if (tilt(turn) <= planar_tolerance) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d moved = turn * axis;
  if (type == JointType::prismatic && off_plane(moved) > planar_tolerance) return Eigen::Matrix3d::Identity();
  if (type == JointType::revolute && off_normal(moved) > planar_tolerance) return Eigen::Matrix3d::Identity();
  Eigen::Vector3d normal = turn.transpose().col(2), x = turn.transpose().col(0);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    if (normal.cross(unit).norm() <= planar_tolerance) normal = normal[i] < 0.0 ? Eigen::Vector3d(-unit) : unit;
  }
  if (type == JointType::revolute) normal = moved[2] < 0.0 ? Eigen::Vector3d(-axis) : axis;
  for (Eigen::Index i = 2; i >= 0; --i) {
    if (std::abs(normal[i]) <= planar_tolerance) x = Eigen::Vector3d::Unit(i);
  }
  x = (x - x.dot(normal) * normal).normalized();
  Eigen::Matrix3d out;
  out << x, normal.cross(x), normal;
  return out;
}

class Projector {
 public:
  Projector(const Robot& robot, Options::Plane plane) : robot_(robot), axes_(plane_axes(plane)) {
    out_.plane = plane;
    out_.mounts = robot.mounts;
  }

  PlanarRobot project() {
    out_.joints.resize(robot_.joints.size());
    out_.frames.resize(robot_.links.size());
    out_.poses.resize(robot_.links.size());
    for (const int link : robot_.order) place(link);
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      const Joint& joint = robot_.joints[i];
      const bool known = joint.parent.link != no_link && joint.child.link != no_link;  // the other is an error already
      if (joint.closes_loop && known) see(static_cast<int>(i));
    }
    return std::move(out_);
  }

 private:
  const Mount& mount(int link) const { return link == world_link ? world_ : out_.mounts[at(link)]; }

  void place(int link) {
    Mount& here = out_.mounts[at(link)];
    const int parent = robot_.parent_joint[at(link)];
    if (parent >= 0) set_upright(robot_.joints[at(parent)], link, here);
    const Frame frame = seen(here.pose, axes_);
    out_.frames[at(link)] = flat(frame);
    if (parent < 0) return;
    const Joint& joint = robot_.joints[at(parent)];
    const PlanarPose& carrier = body_pose(joint.parent.link);
    if (here.body != link) {
      if (tilt(frame.turn) > planar_tolerance) out_.tilted_frames.push_back(robot_.links[at(link)].name);
      out_.poses[at(link)] = (here.body == world_link ? PlanarPose{} : out_.poses[at(here.body)]) * flat(frame);
      return;
    }
    see(parent);
    const Eigen::Isometry3d upright_zero = mount(joint.parent.link).pose * joint.child_pose() * inverse_pose(here.pose);
    out_.poses[at(link)] = carrier * flat(seen(upright_zero, axes_));
  }

  /// The pose of a link in the frame of its body, once that frame is upright: a body whose link frame is tilted gets a
  /// frame of its own, with the same origin, and what is part of it moves along.
  void set_upright(const Joint& joint, int link, Mount& mount_of_link) {
    if (mount_of_link.body == world_link) return;
    if (mount_of_link.body != link) {
      mount_of_link.pose = out_.mounts[at(mount_of_link.body)].pose * mount_of_link.pose;
      return;
    }
    const Frame zero = seen(mount(joint.parent.link).pose * joint.child_pose(), axes_);
    const Eigen::Matrix3d turn = upright(zero.turn, axes_ * (joint.child.frame.linear() * joint.axis), joint.type);
    if (turn.isIdentity(0.0)) return;
    mount_of_link.pose.linear() = axes_.transpose() * turn.transpose() * axes_;
    out_.tilted_frames.push_back(robot_.links[at(link)].name);
  }

  /// Pose at coordinates zero of the body that carries the link.
  PlanarPose body_pose(int link) const {
    const int body = mount(link).body;
    return body == world_link ? PlanarPose{} : out_.poses[at(body)];
  }

  void see(int index) {
    const Joint& joint = robot_.joints[at(index)];
    PlanarJoint& planar = out_.joints[at(index)];
    Frame second = seen(mount(joint.child.link).pose * joint.child.frame, axes_);
    Frame first = seen(mount(joint.parent.link).pose * joint.parent.frame, axes_);
    Eigen::Vector3d axis = axes_ * joint.axis;
    planar.spot = joint.axis_spot;
    // Both frames of a joint may be turned alike. Of one that closes at zero the axis is judged against what follows.
    const Eigen::Matrix3d turn =
        joint.closed_at_zero ? upright(second.turn, axis, JointType::fixed) : upright(first.turn, axis, joint.type);
    if (!turn.isIdentity(0.0)) {
      first.turn *= turn;
      second.turn *= turn;
      if (!joint.axis_in_world) axis = turn.transpose() * axis;
    }
    if (joint.closed_at_zero) {
      const PlanarPose zero = body_pose(joint.child.link) * flat(second);
      planar.first = inverse(body_pose(joint.parent.link)) * zero;
      planar.first.angle = wrapped(planar.first.angle);
      const double turned = joint.axis_in_world ? -zero.angle : 0.0;
      axis = Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()) * axis;
      first.turn = Eigen::AngleAxisd(planar.first.angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    } else {
      planar.first = flat(first);
    }
    planar.second = flat(second);
    judge(joint, first, second, axis, planar);
    if (joint.type == JointType::prismatic) {
      const double along = std::atan2(axis[1], axis[0]);
      planar.first.angle = clean(planar.first.angle + along);
      planar.second.angle = clean(planar.second.angle + along);
    }
  }

  static void judge(const Joint& joint, const Frame& first, const Frame& second, const Eigen::Vector3d& axis,
                    PlanarJoint& planar) {
    const auto worse = [&](double residual, const char* fault, const Spot& spot) {
      if (residual <= planar.residual) return;
      planar.residual = residual;
      if (residual <= planar_tolerance) return;
      planar.fault = fault;
      planar.spot = spot;
    };
    for (const Frame* end : {&first, &second}) {
      // Only the axis counts for a slide or a pin that closes a loop; a link of the tree must stay upright.
      const Eigen::Vector3d here = end->turn * axis;
      if (joint.type == JointType::revolute) {
        worse(off_normal(here), "axis is off the normal of the plane", joint.axis_spot);
        if (end == &first && here[2] < 0.0) planar.sign = -1.0;
      } else if (joint.type == JointType::prismatic) {
        worse(off_plane(here), "axis is out of the plane", joint.axis_spot);
      }
      if (joint.closes_loop && joint.moves()) continue;
      const Spot& spot = end == &first ? joint.parent.frame_spot : joint.child.frame_spot;
      worse(tilt(end->turn), "origin tilts out of the plane", spot);
    }
  }

  const Robot& robot_;
  const Mount world_;
  Eigen::Matrix3d axes_;
  PlanarRobot out_;
};

}  // namespace

Eigen::Matrix3d plane_axes(Options::Plane plane) {
  Eigen::Matrix3d axes;
  switch (plane) {
    case Options::Plane::xz:
      axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
      break;
    case Options::Plane::yz:
      axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
      break;
    case Options::Plane::xy:
      axes.setIdentity();
      break;
  }
  return axes;
}

const char* plane_word(Options::Plane plane) {
  constexpr const char* words[] = {"xy", "xz", "yz"};
  return words[static_cast<int>(plane)];
}

bool PlanarRobot::planar() const {
  return std::ranges::all_of(joints, [](const PlanarJoint& joint) { return joint.fault.empty(); });
}

PlanarRobot project(const Robot& robot, Options::Plane plane) { return Projector(robot, plane).project(); }

void report_not_planar(const Robot& robot, const PlanarRobot& seen, Messages& messages) {
  for (std::size_t i = 0; i < seen.joints.size(); ++i) {
    const PlanarJoint& joint = seen.joints[i];
    if (joint.fault.empty()) continue;
    const Joint& source = robot.joints[i];
    const bool by_default = !source.axis_given && joint.fault.starts_with("axis");
    messages.error(joint.spot, "urdf-not-planar",
                   fmt::format("joint '{}' does not move in the plane {}: its {} by {:.3g} rad", source.name,
                               plane_word(seen.plane), joint.fault, joint.residual),
                   {},
                   by_default
                       ? "no axis is given; URDF then takes 1 0 0"
                       : fmt::format("{:g} rad are allowed; 'space: spatial' in a side-car reads the robot in space",
                                     planar_tolerance));
  }
}

}  // namespace freeplay::urdf
