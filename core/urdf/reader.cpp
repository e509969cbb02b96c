#include "urdf/reader.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "urdf/loops.h"
#include "urdf/mimic.h"
#include "urdf/reference.h"
#include "urdf/shape.h"
#include "urdf/urdfdom_model.h"

namespace freeplay::urdf {
namespace {

/// Elements of a robot that mean nothing to the mechanism, or that are not read here.
constexpr const char* other_parts[] = {"material", "gazebo", "transmission", "coupling", "sensor", "group", "frame"};

std::string label(const XmlElement& xml) {
  const XmlAttribute* name = xml.FindAttribute("name");
  return name == nullptr ? fmt::format("a {}", xml.Name()) : fmt::format("{} '{}'", xml.Name(), name->Value());
}

Eigen::Vector3d vector_of(const ::urdf::Vector3& v) { return {v.x, v.y, v.z}; }

JointType type_of(const ::urdf::Joint& joint) {
  switch (joint.type) {
    case ::urdf::Joint::REVOLUTE:
    case ::urdf::Joint::CONTINUOUS:
      return JointType::revolute;
    case ::urdf::Joint::PRISMATIC:
      return JointType::prismatic;
    case ::urdf::Joint::FLOATING:
      return JointType::floating;
    case ::urdf::Joint::PLANAR:
      return JointType::planar;
    default:
      return JointType::fixed;
  }
}

/// Names of the links that a joint joins, where they are written.
struct Ends {
  std::optional<std::string> parent, child;
};

/// What a joint says, as far as it is there.
struct JointParts {
  std::string type;
  bool has_parent = false, has_child = false, axis_has_numbers = false, has_leader = false;
  XmlElement *limit = nullptr, *dynamics = nullptr, *mimic = nullptr;
};

class RobotReader {
 public:
  RobotReader(XmlElement& root, UrdfdomModel& model, Messages& messages)
      : root_(root), model_(model), messages_(messages), element_(root, "the robot", messages, false) {}

  Robot read() {
    robot_.spot = name_spot(root_);
    element_.require("name");
    element_.find("version");
    for (XmlElement& child : XmlChildren(root_)) {
      if (is(child, "link")) read_link(child);
      if (is(child, "joint")) read_joint(child);
    }
    if (robot_.links.empty()) messages_.error(robot_.spot, "bad-urdf", "the robot has no link");
    resolve();
    const int errors = messages_.errors();
    read_loops(root_, robot_, messages_);
    robot_.places_known = robot_.places_known && messages_.errors() == errors;
    resolve_mimics(robot_, messages_);
    finish();
    return std::move(robot_);
  }

 private:
  // --- links -----------------------------------------------------------------------------------------------------

  void read_link(XmlElement& xml) {
    Element element(xml, label(xml), messages_, false);
    Link link;
    const int errors = messages_.errors();
    link.element = begin_spot(xml);
    link.spot = spot_of(xml, "name");
    element.require("name");
    XmlElement* inertial = element.child("inertial");
    if (inertial != nullptr) check_inertial(*inertial, element.owner(), link);
    const auto read = model_.link(xml, messages_.errors() != errors);
    link.name = read->name;
    if (xml.FindAttribute("name") != nullptr) require_fresh("link", link.name, link.spot, link_lines_);
    if (inertial != nullptr) take_inertial(read->inertial.get(), element.owner(), link);
    for (const char* known : {"visual", "collision"}) element.pass_over(known);
    for (XmlElement& child : XmlChildren(xml)) {
      if (is(child, "visual") || is(child, "collision")) check_shape(child, element.owner(), messages_);
    }
    element.finish();
    robot_.links.push_back(std::move(link));
  }

  void check_inertial(XmlElement& xml, const std::string& owner, Link& link) {
    Element inertial(xml, "the inertial of " + owner, messages_, true);
    const int errors = messages_.errors();
    link.inertial.linear() = read_origin(inertial, messages_).linear();
    link.inertia_known = messages_.errors() == errors;
    XmlElement* mass = inertial.required_child("mass");
    if (mass != nullptr) check_mass(*mass, owner, link);
    XmlElement* inertia = inertial.required_child("inertia");
    if (inertia != nullptr) check_inertia(*inertia, owner, link);
    inertial.finish();
    if (mass == nullptr) xml.InsertNewChildElement("mass")->SetAttribute("value", "1");
    if (inertia != nullptr) return;
    XmlElement* guess = xml.InsertNewChildElement("inertia");
    for (const char* key : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) guess->SetAttribute(key, "0");
  }

  void check_mass(XmlElement& xml, const std::string& owner, Link& link) {
    Element mass(xml, "the mass of " + owner, messages_, true);
    mass.required_number("value", "1");  // the link is not without mass
    link.mass_spot = spot_of(xml, "value");
    mass.finish();
  }

  void check_inertia(XmlElement& xml, const std::string& owner, Link& link) {
    Element inertia(xml, "the inertia of " + owner, messages_, true);
    for (const char* key : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) {
      link.inertia_known = inertia.required_number(key) && link.inertia_known;
    }
    link.moments = {spot_of(xml, "ixx"), spot_of(xml, "iyy"), spot_of(xml, "izz")};
    link.inertia_spot = xml.FirstAttribute() == nullptr ? name_spot(xml) : spot_of(xml, *xml.FirstAttribute());
    inertia.finish();
  }

  void take_inertial(const ::urdf::Inertial* read, const std::string& owner, Link& link) {
    link.has_inertial = true;
    link.mass = 1.0;
    if (read == nullptr) {
      link.inertia_known = false;
      return;
    }
    link.inertial.translation() = vector_of(read->origin.position);
    link.inertia << read->ixx, read->ixy, read->ixz, read->ixy, read->iyy, read->iyz, read->ixz, read->iyz, read->izz;
    if (read->mass >= 0.0) {
      link.mass = read->mass;
    } else {
      messages_.error(link.mass_spot, "bad-urdf",
                      fmt::format("the mass of {} must be positive, not {} kg", owner, read->mass));
    }
  }

  // --- joints ----------------------------------------------------------------------------------------------------

  void read_joint(XmlElement& xml) {
    Element element(xml, label(xml), messages_, false);
    Joint joint;
    const int errors = messages_.errors();
    JointParts parts;
    check_place(element, joint, parts);
    robot_.places_known = robot_.places_known && messages_.errors() == errors;
    check_values(element, parts);
    const auto read = model_.joint(xml, messages_.errors() != errors);
    joint.name = read->name;
    if (xml.FindAttribute("name") != nullptr) require_fresh("joint", joint.name, joint.spot, joint_lines_);
    ends_.emplace_back();
    if (parts.has_parent) ends_.back().parent = read->parent_link_name;
    if (parts.has_child) ends_.back().child = read->child_link_name;
    take_joint(*read, parts, element.owner(), joint);
    check_calibration(element);
    check_safety(element);
    element.finish();
    robot_.joints.push_back(std::move(joint));
  }

  /// Name, type, origin, ends and axis.
  void check_place(Element& element, Joint& joint, JointParts& parts) {
    XmlElement& xml = element.xml();
    joint.element = joint.axis_spot = begin_spot(xml);
    joint.spot = spot_of(xml, "name");
    element.require("name");
    const XmlAttribute* type = element.require("type");
    joint.type_spot = type == nullptr ? joint.spot : spot_of(xml, *type);
    parts.type = type == nullptr ? "" : type->Value();
    if (type != nullptr) check_type(parts.type, joint.type_spot, element.owner());
    joint.parent.frame.linear() = read_origin(element, messages_, &joint.parent.frame_spot).linear();
    parts.has_parent = check_end(element, "parent", joint.parent);
    parts.has_child = check_end(element, "child", joint.child);
    XmlElement* axis = element.child("axis");
    const bool has_axis =
        parts.type == "revolute" || parts.type == "continuous" || parts.type == "prismatic" || parts.type == "planar";
    if (axis == nullptr || !has_axis) return;
    joint.axis_given = true;
    joint.axis_spot = spot_of(*axis, "xyz");
    parts.axis_has_numbers = axis->FindAttribute("xyz") != nullptr;
    Element checked(*axis, "the axis of " + element.owner(), messages_, false);
    checked.vector("xyz", "1 0 0");
    checked.finish();
  }

  void check_type(const std::string& type, const Spot& spot, const std::string& owner) {
    const std::vector<std::string> words = {"revolute", "continuous", "prismatic", "fixed", "floating", "planar"};
    if (std::ranges::find(words, type) != words.end()) return;
    messages_.error(spot, "bad-urdf", fmt::format("unknown type '{}' of {}", type, owner),
                    messages_.suggest(type, words), "types: revolute, continuous, prismatic, fixed, floating, planar");
  }

  /// False where no link is named.
  bool check_end(Element& joint, const char* side, End& end) {
    XmlElement* xml = joint.child(side);
    end.spot = joint.name_spot();
    if (xml == nullptr) {
      messages_.error(end.spot, "bad-urdf",
                      fmt::format("{} has no {}: the element '{}' is missing", joint.owner(), side, side));
      return false;
    }
    Element element(*xml, fmt::format("the {} of {}", side, joint.owner()), messages_, true);
    const XmlAttribute* link = element.require("link");
    element.finish();
    if (link != nullptr) end.spot = spot_of(*xml, *link);
    return link != nullptr;
  }

  /// Limit, dynamics and mimic.
  void check_values(Element& element, JointParts& parts) {
    parts.limit = element.child("limit");
    const bool needed = parts.type == "revolute" || parts.type == "prismatic";
    if (parts.limit != nullptr) {
      Element limit(*parts.limit, "the limit of " + element.owner(), messages_, false);
      for (const char* key : {"lower", "upper"}) limit.number(key, 0.0);
      for (const char* key : {"effort", "velocity"}) limit.required_number(key);
      limit.finish();
    } else if (needed) {
      element.required_child("limit");
    }
    parts.dynamics = element.child("dynamics");
    if (parts.dynamics != nullptr) check_dynamics(*parts.dynamics, element.owner());
    parts.mimic = element.child("mimic");
    if (parts.mimic == nullptr) return;
    Element mimic(*parts.mimic, "the mimic of " + element.owner(), messages_, true);
    parts.has_leader = mimic.require("joint") != nullptr;
    mimic.number("multiplier", 1.0);
    mimic.number("offset", 0.0);
    mimic.finish();
    if (!parts.has_leader) parts.mimic->SetAttribute("joint", "");
  }

  void check_dynamics(XmlElement& xml, const std::string& owner) {
    Element dynamics(xml, "the dynamics of " + owner, messages_, false);
    for (const char* key : {"damping", "friction"}) dynamics.number(key, 0.0);
    dynamics.finish();
    if (xml.FindAttribute("damping") != nullptr || xml.FindAttribute("friction") != nullptr) return;
    messages_.error(dynamics.name_spot(), "bad-urdf",
                    fmt::format("{} say neither damping nor friction", dynamics.owner()));
    xml.SetAttribute("damping", "0");
  }

  void take_joint(const ::urdf::Joint& read, const JointParts& parts, const std::string& owner, Joint& joint) {
    joint.type = type_of(read);
    if (read.type == ::urdf::Joint::UNKNOWN) {
      robot_.places_known = false;
      return;
    }
    joint.parent.frame.translation() = vector_of(read.parent_to_joint_origin_transform.position);
    if (joint.axis_given) {
      const int errors = messages_.errors();
      // urdfdom reads an axis without numbers as 0 0 0.
      const Eigen::Vector3d axis = parts.axis_has_numbers ? vector_of(read.axis) : Eigen::Vector3d::UnitX();
      joint.axis = unit_axis(axis, joint.axis_spot, "the axis of " + owner, messages_);
      robot_.places_known = robot_.places_known && messages_.errors() == errors;
    }
    if (parts.limit != nullptr) take_limits(read, *parts.limit, "the limit of " + owner, joint);
    if (parts.dynamics != nullptr) take_dynamics(*read.dynamics, *parts.dynamics, "the dynamics of " + owner, joint);
    if (parts.mimic != nullptr) take_mimic(*read.mimic, parts, "the mimic of " + owner, joint);
  }

  void take_limits(const ::urdf::Joint& read, const XmlElement& xml, const std::string& owner, Joint& joint) {
    const ::urdf::JointLimits& limits = *read.limits;
    if (limits.lower > limits.upper) {
      messages_.error(spot_of(xml, xml.FindAttribute("lower") != nullptr ? "lower" : "upper"), "bad-urdf",
                      fmt::format("{}: lower {} is above upper {}", owner, limits.lower, limits.upper));
    }
    joint.reach = std::max(std::abs(limits.lower), std::abs(limits.upper));
    if (read.type == ::urdf::Joint::CONTINUOUS || !joint.has_coordinate()) return;
    joint.limits = Limits{limits.lower, limits.upper, limits.effort, name_spot(xml)};
    if (joint.turns()) doubt_degrees(limits, xml, owner);
  }

  void doubt_degrees(const ::urdf::JointLimits& limits, const XmlElement& xml, const std::string& owner) {
    for (const auto& [key, angle] : {std::pair{"lower", limits.lower}, std::pair{"upper", limits.upper}}) {
      if (!looks_like_degrees(angle)) continue;
      messages_.warning(spot_of(xml, key), "doubtful-angle",
                        fmt::format("'{}' of {} is {:.6g} rad, {:.3g} turns: robot files are in radians, not in "
                                    "degrees",
                                    key, owner, angle, std::abs(angle) / (2.0 * std::numbers::pi)));
      return;
    }
  }

  void take_dynamics(const ::urdf::JointDynamics& read, const XmlElement& xml, const std::string& owner, Joint& joint) {
    joint.damping = not_negative(read.damping, xml, "damping", owner);
    joint.friction = not_negative(read.friction, xml, "friction", owner);
    if (xml.FindAttribute("damping") != nullptr) joint.damping_spot = spot_of(xml, "damping");
    if (xml.FindAttribute("friction") != nullptr) joint.friction_spot = spot_of(xml, "friction");
    if (joint.has_coordinate()) return;
    if (joint.damping > 0.0) messages_.ignore("damping of joint", joint.name);
    if (joint.friction > 0.0) messages_.ignore("friction of joint", joint.name);
  }

  double not_negative(double value, const XmlElement& xml, const char* key, const std::string& owner) {
    if (value >= 0.0) return value;
    messages_.error(spot_of(xml, key), "bad-urdf", fmt::format("{} in {} must not be negative: {}", key, owner, value));
    return 0.0;
  }

  void take_mimic(const ::urdf::JointMimic& read, const JointParts& parts, const std::string& owner, Joint& joint) {
    const XmlElement& xml = *parts.mimic;
    Mimic mimic;
    mimic.joint = read.joint_name;
    mimic.multiplier = read.multiplier;
    mimic.offset = read.offset;
    mimic.spot = spot_of(xml, "joint");
    mimic.multiplier_spot = spot_of(xml, "multiplier");
    mimic.offset_spot = spot_of(xml, "offset");
    if (mimic.multiplier == 0.0) {
      messages_.error(mimic.multiplier_spot, "bad-urdf", fmt::format("the multiplier of {} must not be 0", owner));
    }
    if (parts.has_leader) joint.mimic = mimic;
  }

  void check_calibration(Element& joint) {
    XmlElement* xml = joint.child("calibration");
    if (xml == nullptr) return;
    Element calibration(*xml, "the calibration of " + joint.owner(), messages_, false);
    for (const char* key : {"rising", "falling", "reference_position"}) calibration.number(key, 0.0);
    calibration.finish();
    messages_.ignore("calibration");
  }

  void check_safety(Element& joint) {
    XmlElement* xml = joint.child("safety_controller");
    if (xml == nullptr) return;
    Element safety(*xml, "the safety_controller of " + joint.owner(), messages_, false);
    safety.required_number("k_velocity");
    for (const char* key : {"k_position", "soft_lower_limit", "soft_upper_limit"}) safety.number(key, 0.0);
    safety.finish();
    messages_.ignore("safety_controller");
  }

  // --- references ------------------------------------------------------------------------------------------------

  void require_fresh(const char* kind, const std::string& name, const Spot& spot,
                     std::unordered_map<std::string, int>& lines) {
    if (name.empty()) messages_.error(spot, "bad-urdf", fmt::format("the name of a {} is empty", kind));
    const auto [known, fresh] = lines.emplace(name, spot.line);
    if (fresh) return;
    robot_.ambiguous = true;
    messages_.error(spot, "bad-urdf",
                    fmt::format("the {} '{}' exists already: first on line {}", kind, name, known->second));
  }

  void resolve() {
    const LinkNames names(robot_.links);
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      Joint& joint = robot_.joints[i];
      const auto& [parent, child] = ends_[i];
      if (parent) joint.parent.link = names.find(*parent, joint.parent.spot, messages_);
      if (child) joint.child.link = names.find(*child, joint.child.spot, messages_);
      robot_.ambiguous = robot_.ambiguous || joint.parent.link == no_link || joint.child.link == no_link;
      if (joint.parent.link != no_link && joint.parent.link == joint.child.link) {
        messages_.error(joint.child.spot, "bad-urdf",
                        fmt::format("joint '{}' joins link '{}' to itself", joint.name, *child));
      }
    }
  }

  // --- the rest --------------------------------------------------------------------------------------------------

  void finish() {
    for (XmlElement& child : XmlChildren(root_)) note_other(child);
    for (const char* known : {"link", "joint"}) element_.pass_over(known);
    finish_known();
  }

  void note_other(XmlElement& child) {
    if (is(child, "coupling")) {
      messages_.warning(name_spot(child), "urdf-ignored",
                        fmt::format("the {} ties joints and is not read", label(child)),
                        "a gear in a side-car can say it");
    } else if (is(child, "transmission")) {
      const XmlAttribute* name = child.FindAttribute("name");
      messages_.ignore("transmission", name == nullptr ? "" : name->Value());
    } else if (is(child, "material")) {
      check_material(child, messages_);
    }
  }

  /// Unknown parts of the robot: those that are known to others are counted only.
  void finish_known() {
    const std::vector<std::string> words = {"link", "joint", "loop", "loop_joint", "constraint"};
    for (const XmlAttribute* at = root_.FirstAttribute(); at != nullptr; at = at->Next()) {
      const std::string_view name = at->Name();
      if (name == "name" || name == "version" || name.starts_with("xmlns")) continue;
      messages_.ignore(fmt::format("attribute '{}' of 'robot'", name));
    }
    for (const XmlElement& child : XmlChildren(root_)) {
      const std::string name = child.Name();
      if (std::ranges::find(words, name) != words.end()) continue;
      if (name == "coupling" || name == "transmission" || is_loop_carrier(child)) continue;
      if (name.starts_with("xacro:")) {
        messages_.error(name_spot(child), "bad-urdf", fmt::format("'{}' is not expanded", name), {},
                        "this is a xacro file; expand it first");
        continue;
      }
      const bool known = std::ranges::find(other_parts, name) != std::end(other_parts);
      const std::string meant = known ? "" : misspelt(name, words);
      if (meant.empty()) {
        messages_.ignore(name);
      } else {
        messages_.error(name_spot(child), "bad-urdf", fmt::format("unknown element '{}' in the robot", name), meant);
      }
    }
    if (!text_of(root_).empty()) messages_.error(text_spot(root_), "bad-urdf", "unexpected text in the robot");
  }

  XmlElement& root_;
  UrdfdomModel& model_;
  Messages& messages_;
  Element element_;
  Robot robot_;
  std::vector<Ends> ends_;  ///< of each joint
  std::unordered_map<std::string, int> link_lines_, joint_lines_;
};

}  // namespace

Robot read_robot(XmlElement& root, UrdfdomModel& model, Messages& messages) {
  return RobotReader(root, model, messages).read();
}

}  // namespace freeplay::urdf
