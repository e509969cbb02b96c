#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "mjcf/joints.h"
#include "mjcf/pose.h"

namespace freeplay::mjcf {
namespace {

using urdf::JointType;
using Kind = OwnJoint::Kind;

constexpr double same_place = 1e-9;      // [m]
constexpr double same_direction = 1e-6;  // [rad]

/// A type and the frame of both its ends in the body.
struct Union {
  JointType type;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
};

Eigen::Isometry3d frame_at(const Eigen::Vector3d& place, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translation() = place;
  frame.linear() = turn;
  return frame;
}

/// Where two axes that are not parallel meet; empty where they do not.
std::optional<Eigen::Vector3d> meeting(const OwnJoint& a, const OwnJoint& b) {
  const Eigen::Vector3d &u = a.joint.axis, &v = b.joint.axis, normal = u.cross(v), way = b.position - a.position;
  if (normal.norm() < same_direction || std::abs(way.dot(normal.normalized())) > same_place) return std::nullopt;
  return a.position + u * (way.cross(v).dot(normal) / normal.squaredNorm());
}

double volume(const OwnJoint& a, const OwnJoint& b, const OwnJoint& c) {
  return std::abs(a.joint.axis.cross(b.joint.axis).dot(c.joint.axis));
}

std::optional<Union> union_of_two(const OwnJoint& a, const OwnJoint& b) {
  const Eigen::Vector3d &u = a.joint.axis, &v = b.joint.axis;
  if (a.kind != b.kind) {
    const OwnJoint& hinge = a.kind == Kind::hinge ? a : b;
    if (u.cross(v).norm() > same_direction) return std::nullopt;
    return Union{JointType::cylindrical, frame_at(hinge.position, turn_to(hinge.joint.axis))};
  }
  const auto point = meeting(a, b);
  if (a.kind != Kind::hinge || !point || std::abs(u.dot(v)) > same_direction) return std::nullopt;
  Eigen::Matrix3d axes;
  axes.col(0) = u;
  axes.col(2) = u.cross(v).normalized();
  axes.col(1) = axes.col(2).cross(u);
  return Union{JointType::universal, frame_at(*point, axes)};
}

std::optional<Union> union_of_hinges(const OwnJoint& a, const OwnJoint& b, const OwnJoint& c) {
  auto point = meeting(a, b);
  if (!point || volume(a, b, c) < same_direction) return std::nullopt;
  if ((*point - c.position).cross(c.joint.axis).norm() > same_place) return std::nullopt;
  for (const OwnJoint* one : {&c, &b, &a}) {
    if ((*point - one->position).norm() < same_place) point = one->position;  // without the rounding of the meeting
  }
  return Union{JointType::spherical, frame_at(*point)};
}

/// Several hinges and slides, in the order in which they follow each other from the parent.
std::optional<Union> union_of(const std::vector<OwnJoint>& own) {
  std::vector<const OwnJoint*> slides, hinges, balls;
  for (const OwnJoint& one : own) {
    if (one.kind == Kind::free) return std::nullopt;
    (one.kind == Kind::slide ? slides : one.kind == Kind::hinge ? hinges : balls).push_back(&one);
  }
  const bool turns_freely = (balls.size() == 1 && hinges.empty()) ||
                            (balls.empty() && hinges.size() == 3 && volume(*hinges[0], *hinges[1], *hinges[2]) > 0.01);
  if (slides.size() == 3 && turns_freely && volume(*slides[0], *slides[1], *slides[2]) > 0.01) {
    return Union{JointType::floating};
  }
  if (!balls.empty()) return std::nullopt;
  if (own.size() == 2) return union_of_two(own[0], own[1]);
  if (own.size() != 3) return std::nullopt;
  if (hinges.size() == 3) return union_of_hinges(own[0], own[1], own[2]);
  if (hinges.size() != 1) return std::nullopt;
  const Eigen::Vector3d &normal = hinges[0]->joint.axis, &u = slides[0]->joint.axis, &v = slides[1]->joint.axis;
  if (std::abs(normal.dot(u)) > same_direction || std::abs(normal.dot(v)) > same_direction) return std::nullopt;
  if (u.cross(v).norm() < 0.01) return std::nullopt;
  return Union{JointType::planar, frame_at(hinges[0]->position)};
}

std::string listed(const std::vector<OwnJoint>& own) {
  std::string out;
  constexpr std::size_t most = 6;
  for (std::size_t i = 0; i < std::min(own.size(), most); ++i) {
    out += fmt::format("{}'{}'", out.empty() ? "" : ", ", own[i].joint.name);
  }
  return own.size() > most ? fmt::format("{} and {} more", out, own.size() - most) : out;
}

/// What acts on a coordinate has none to act on once joints are one.
void leave_out_forces(urdf::Joint& joint, Messages& messages) {
  const auto leave = [&](double& value, const char* what) {
    if (value > 0.0) messages.ignore(fmt::format("{} of joint", what), joint.name);
    value = 0.0;
  };
  leave(joint.damping, "damping");
  leave(joint.stiffness, "spring");
  leave(joint.friction, "friction");
  if (joint.limits) messages.ignore("limits of joint", joint.name);
  joint.limits.reset();
}

urdf::Joint one_of(std::vector<OwnJoint>& own, const Hanging& body, Eigen::Isometry3d& frame, Messages& messages) {
  const std::optional<Union> found = union_of(own);
  if (!found) {
    messages.error(
        own[0].joint.spot, "bad-urdf",
        fmt::format("the joints {} of body '{}' together are no joint that is known here", listed(own), body.name), {},
        "known are hinge and slide along one axis, two slides and a hinge normal to them, two hinges that "
        "cross at a right angle, three that meet in a point, and all six; else put bodies with mass between");
    return own[0].joint;
  }
  std::string name;
  for (OwnJoint& one : own) {
    leave_out_forces(one.joint, messages);
    name += (name.empty() ? "" : "-") + one.joint.name;
  }
  urdf::Joint joint = own[0].joint;
  joint.name = name;
  joint.type = found->type;
  for (const OwnJoint& one : own) {
    if (found->type == JointType::planar && one.kind == Kind::hinge) joint.axis = one.joint.axis;
  }
  frame = found->frame;
  if (found->type != JointType::floating) {
    messages.warning(joint.spot, "urdf-renamed",
                     fmt::format("the joints {} of body '{}' are one joint '{}' here", listed(own), body.name, name));
  }
  return joint;
}

}  // namespace

urdf::Joint joint_of_body(std::vector<OwnJoint> own, const Hanging& body, NamePool& names, Messages& messages) {
  urdf::Joint joint;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  if (own.empty()) {
    joint.name = names.fresh(body.name + "-fixed");
    joint.spot = joint.element = joint.axis_spot = joint.type_spot = body.spot;
    joint.axis_given = true;
  }
  for (OwnJoint& one : own) {
    if (one.joint.name.empty()) one.joint.name = names.fresh(body.name + "-joint");
  }
  if (own.size() == 1) {
    joint = own[0].joint;
    if (!joint.has_coordinate()) leave_out_forces(joint, messages);
    if (joint.type != JointType::floating) frame = frame_at(own[0].position);
  }
  if (own.size() > 1) joint = one_of(own, body, frame, messages);
  if (joint.type == JointType::floating && body.parent != 0) {
    messages.error(joint.spot, "bad-urdf",
                   fmt::format("only bodies of the worldbody can be free, not body '{}'", body.name));
  }
  joint.parent = {body.parent, body.pose * frame, body.spot, body.spot};
  joint.child = {body.link, frame, body.spot, body.spot};
  return joint;
}

}  // namespace freeplay::mjcf
