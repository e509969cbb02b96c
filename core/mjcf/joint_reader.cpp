#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "mjcf/angles.h"
#include "mjcf/joints.h"
#include "urdf/reference.h"

namespace freeplay::mjcf {
namespace {

class OwnJointReader {
 public:
  OwnJointReader(XmlElement& xml, const Settings& settings, Messages& messages)
      : xml_(xml), settings_(settings), messages_(messages), element_(xml, owner_of(xml), messages, false) {}

  OwnJoint read(const Eigen::Isometry3d& frame) {
    read_head();
    const Eigen::Vector3d position = element_.vector("pos").value_or(Eigen::Vector3d::Zero());
    out_.position = frame * position;
    read_axis(frame);
    read_range();
    read_forces();
    for (const char* name : {"class", "group", "user", "align"}) element_.find(name);
    element_.finish();
    return std::move(out_);
  }

 private:
  using Kind = OwnJoint::Kind;

  static std::string owner_of(const XmlElement& xml) {
    const char* name = xml.Attribute("name");
    return name == nullptr ? fmt::format("a {}", xml.Name()) : fmt::format("{} '{}'", xml.Name(), name);
  }

  bool has_coordinate() const { return out_.kind == Kind::hinge || out_.kind == Kind::slide; }
  double unit() const { return out_.kind == Kind::slide ? 1.0 : settings_.angle_unit; }

  void read_head() {
    urdf::Joint& joint = out_.joint;
    joint.element = joint.axis_spot = element_.begin_spot();
    joint.spot = spot_of(xml_, "name");
    joint.type_spot = spot_of(xml_, "type");
    if (const XmlAttribute* name = element_.find("name")) joint.name = name->Value();
    const bool is_free = urdf::is(xml_, "freejoint");
    out_.kind = is_free ? Kind::free
                        : static_cast<Kind>(choice(element_, "type", {"free", "ball", "slide", "hinge"}, 3, messages_));
    constexpr urdf::JointType types[] = {urdf::JointType::floating, urdf::JointType::spherical,
                                         urdf::JointType::prismatic, urdf::JointType::revolute};
    joint.type = types[static_cast<std::size_t>(out_.kind)];
  }

  void read_axis(const Eigen::Isometry3d& frame) {
    out_.joint.axis_given = true;
    out_.joint.axis = Eigen::Vector3d::UnitZ();
    if (element_.find("axis") != nullptr) out_.joint.axis_spot = spot_of(xml_, "axis");
    const auto axis = element_.vector("axis");
    if (axis && has_coordinate()) {
      out_.joint.axis = urdf::unit_axis(*axis, out_.joint.axis_spot, "the axis of " + element_.owner(), messages_);
    }
    out_.joint.axis = frame.linear() * out_.joint.axis;
  }

  /// Coordinates count from the pose in which the file draws the body, which MJCF calls `ref`.
  void read_range() {
    const double reference = unit() * element_.number("ref", 0.0);
    const std::vector<double> range = element_.numbers("range", 2);
    const std::size_t limited = choice(element_, "limited", {"false", "true", "auto"}, 2, messages_);
    const double slack = unit() * element_.number("springref", 0.0);
    out_.joint.slack_at = slack - reference;
    if (reference != 0.0 && has_coordinate()) {
      messages_.warning(
          spot_of(xml_, "ref"), "urdf-ignored",
          fmt::format("the coordinate of {} counts from the pose of the file, not from 'ref'", element_.owner()));
    }
    const bool counts = limited == 1 || (limited == 2 && settings_.auto_limits && !range.empty());
    if (out_.kind == Kind::slide) out_.joint.reach = urdf::endless_reach;
    if (!counts || out_.kind == Kind::free) return;
    if (range.empty() || (has_coordinate() && range[0] >= range[1])) {
      messages_.error(spot_of(xml_, range.empty() ? "limited" : "range"), "bad-urdf",
                      fmt::format("{} is limited and needs a range from a lower to a higher end", element_.owner()));
      return;
    }
    if (!has_coordinate()) {
      messages_.ignore("limits of joint", out_.joint.name);
      return;
    }
    if (out_.kind == Kind::hinge) doubt_angles(range, "range", xml_, element_.owner(), settings_, messages_);
    urdf::Limits limits{unit() * range[0] - reference, unit() * range[1] - reference, 0.0, spot_of(xml_, "range")};
    if (out_.kind == Kind::slide) out_.joint.reach = std::max(std::abs(limits.lower), std::abs(limits.upper));
    out_.joint.limits = limits;
  }

  double not_negative(const char* name, Spot& spot) {
    const double value = element_.number(name, 0.0);
    spot = spot_of(xml_, name);
    if (value >= 0.0) return value;
    messages_.error(spot, "bad-urdf", fmt::format("{} of {} must not be negative: {}", name, element_.owner(), value));
    return 0.0;
  }

  void read_forces() {
    urdf::Joint& joint = out_.joint;
    joint.damping = not_negative("damping", joint.damping_spot);
    joint.stiffness = not_negative("stiffness", joint.stiffness_spot);
    joint.friction = not_negative("frictionloss", joint.friction_spot);
    Spot spot;
    if (not_negative("armature", spot) > 0.0) {
      messages_.warning(spot, "urdf-ignored",
                        fmt::format("the armature of {}, the inertia of its motor, is not used", element_.owner()));
    }
    const std::vector<double> timing = element_.numbers("springdamper", 2);
    if (timing.empty() || timing[0] <= 0.0 || timing[1] <= 0.0) return;
    messages_.warning(spot_of(xml_, "springdamper"), "urdf-ignored",
                      fmt::format("the springdamper of {} is not used", element_.owner()),
                      "write its 'stiffness' and 'damping'");
  }

  XmlElement& xml_;
  const Settings& settings_;
  Messages& messages_;
  Element element_;
  OwnJoint out_;
};

}  // namespace

OwnJoint read_joint(XmlElement& xml, const Eigen::Isometry3d& frame, const Settings& settings, Messages& messages) {
  return OwnJointReader(xml, settings, messages).read(frame);
}

}  // namespace freeplay::mjcf
