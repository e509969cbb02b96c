#include "urdf/reader.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

#include "urdf/loops.h"
#include "urdf/reference.h"
#include "urdf/shape.h"

namespace freeplay::urdf {
namespace {

/// Elements of a robot that mean nothing to the mechanism, or that are not read here.
constexpr const char* other_parts[] = {"material", "gazebo", "transmission", "coupling", "sensor", "group", "frame"};

std::string label(const XmlElement& xml) {
  const XmlAttribute* name = xml.attribute("name");
  return name == nullptr ? fmt::format("a {}", xml.name) : fmt::format("{} '{}'", xml.name, name->value);
}

class RobotReader {
 public:
  RobotReader(const XmlElement& root, Messages& messages)
      : root_(root), messages_(messages), element_(root, "the robot", messages, false) {}

  Robot read() {
    robot_.spot = name_spot(root_);
    if (root_.name != "robot") {
      messages_.error(robot_.spot, "bad-urdf", fmt::format("the root element must be 'robot', not '{}'", root_.name));
      return robot_;
    }
    if (const XmlAttribute* name = element_.require("name")) robot_.name = name->value;
    element_.find("version");
    for (const XmlElement& child : root_.children) {
      if (child.name == "link") read_link(child);
      if (child.name == "joint") read_joint(child);
    }
    if (robot_.links.empty()) messages_.error(robot_.spot, "bad-urdf", "the robot has no link");
    resolve();
    const int errors = messages_.errors();
    read_loops(root_, robot_, messages_);
    robot_.places_known = robot_.places_known && messages_.errors() == errors;
    resolve_mimics();
    finish();
    return std::move(robot_);
  }

 private:
  // --- links -----------------------------------------------------------------------------------------------------

  void read_link(const XmlElement& xml) {
    Element element(xml, label(xml), messages_, false);
    Link link;
    link.element = begin_spot(xml);
    link.spot = name_spot(xml);
    if (const XmlAttribute* name = element.require("name")) {
      link.name = name->value;
      link.spot = spot_of(*name);
      require_fresh("link", link.name, link.spot, link_lines_);
    }
    if (const XmlElement* inertial = element.child("inertial")) read_inertial(*inertial, element.owner(), link);
    for (const char* known : {"visual", "collision"}) element.pass_over(known);
    for (const XmlElement& child : xml.children) {
      if (child.name == "visual" || child.name == "collision") check_shape(child, element.owner(), messages_);
    }
    element.finish();
    robot_.links.push_back(std::move(link));
  }

  void read_inertial(const XmlElement& xml, const std::string& owner, Link& link) {
    Element inertial(xml, "the inertial of " + owner, messages_, true);
    link.has_inertial = true;
    const int errors = messages_.errors();
    link.inertial = read_origin(inertial, messages_);
    link.inertia_known = messages_.errors() == errors;
    link.mass = 1.0;  // where it cannot be read: the link is not without mass
    if (const XmlElement* child = inertial.required_child("mass")) {
      Element mass(*child, "the mass of " + owner, messages_, true);
      const auto value = mass.required_number("value");
      link.mass = value.value_or(1.0);
      link.mass_spot = child->attribute("value") == nullptr ? name_spot(*child) : spot_of(*child->attribute("value"));
      if (link.mass < 0.0) {
        messages_.error(link.mass_spot, "bad-urdf",
                        fmt::format("the mass of {} must be positive, not {} kg", owner, link.mass));
        link.mass = 1.0;
      }
      mass.finish();
    }
    if (const XmlElement* child = inertial.required_child("inertia")) read_inertia(*child, owner, link);
    inertial.finish();
  }

  void read_inertia(const XmlElement& xml, const std::string& owner, Link& link) {
    Element inertia(xml, "the inertia of " + owner, messages_, true);
    constexpr const char* names[3][3] = {{"ixx", "ixy", "ixz"}, {"ixy", "iyy", "iyz"}, {"ixz", "iyz", "izz"}};
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        const auto value = inertia.required_number(names[i][j]);
        link.inertia(i, j) = link.inertia(j, i) = value.value_or(0.0);
        link.inertia_known = link.inertia_known && value;
      }
      const XmlAttribute* moment = xml.attribute(names[i][i]);
      link.moments[static_cast<std::size_t>(i)] = moment == nullptr ? name_spot(xml) : spot_of(*moment);
    }
    link.inertia_spot = xml.attributes.empty() ? name_spot(xml) : spot_of(xml.attributes.front());
    inertia.finish();
  }

  // --- joints ----------------------------------------------------------------------------------------------------

  void read_joint(const XmlElement& xml) {
    Element element(xml, label(xml), messages_, false);
    Joint joint;
    const int errors = messages_.errors();
    joint.element = begin_spot(xml);
    joint.spot = name_spot(xml);
    if (const XmlAttribute* name = element.require("name")) {
      joint.name = name->value;
      joint.spot = spot_of(*name);
      require_fresh("joint", joint.name, joint.spot, joint_lines_);
    }
    const XmlAttribute* type = element.require("type");
    if (type != nullptr) joint.type = read_type(*type, element.owner());
    joint.type_spot = type == nullptr ? joint.spot : spot_of(*type);
    joint.parent.frame = read_origin(element, messages_, &joint.parent.frame_spot);
    references_.push_back({read_end(element, "parent", joint.parent), read_end(element, "child", joint.child)});
    read_axis_of(element, joint);
    robot_.places_known = robot_.places_known && messages_.errors() == errors;
    read_limit(element, type, joint);
    read_dynamics(element, joint);
    read_mimic(element, joint);
    check_calibration(element);
    check_safety(element);
    element.finish();
    robot_.joints.push_back(std::move(joint));
  }

  JointType read_type(const XmlAttribute& type, const std::string& owner) {
    static const std::vector<std::string> words = {"revolute", "continuous", "prismatic",
                                                   "fixed",    "floating",   "planar"};
    constexpr JointType types[] = {JointType::revolute, JointType::revolute, JointType::prismatic,
                                   JointType::fixed,    JointType::floating, JointType::planar};
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (type.value == words[i]) return types[i];
    }
    messages_.error(spot_of(type), "bad-urdf", fmt::format("unknown type '{}' of {}", type.value, owner),
                    messages_.suggest(type.value, words),
                    "types: revolute, continuous, prismatic, fixed, floating, planar");
    return JointType::fixed;
  }

  /// The name of the link, or null after a message.
  const XmlAttribute* read_end(Element& joint, const char* side, End& end) {
    const XmlElement* xml = joint.child(side);
    end.spot = joint.name_spot();
    if (xml == nullptr) {
      messages_.error(end.spot, "bad-urdf",
                      fmt::format("{} has no {}: the element '{}' is missing", joint.owner(), side, side));
      return nullptr;
    }
    Element element(*xml, fmt::format("the {} of {}", side, joint.owner()), messages_, true);
    const XmlAttribute* link = element.require("link");
    element.finish();
    if (link != nullptr) end.spot = spot_of(*link);
    return link;
  }

  void read_axis_of(Element& element, Joint& joint) {
    const XmlElement* xml = element.child("axis");
    joint.axis_spot = joint.element;
    if (xml == nullptr || joint.type == JointType::fixed || joint.type == JointType::floating) return;
    joint.axis_given = true;
    joint.axis = read_axis(*xml, "the axis of " + element.owner(), messages_, joint.axis_spot);
  }

  void read_limit(Element& element, const XmlAttribute* type, Joint& joint) {
    const XmlElement* xml = element.child("limit");
    const bool needed = type != nullptr && (type->value == "revolute" || type->value == "prismatic");
    if (xml == nullptr) {
      if (needed) element.required_child("limit");
      return;
    }
    Element limit(*xml, "the limit of " + element.owner(), messages_, false);
    const double lower = limit.number("lower", 0.0), upper = limit.number("upper", 0.0);
    const auto effort = limit.required_number("effort");
    limit.required_number("velocity");
    if (lower > upper) {
      const XmlAttribute* at = xml->attribute("lower") != nullptr ? xml->attribute("lower") : xml->attribute("upper");
      messages_.error(spot_of(*at), "bad-urdf",
                      fmt::format("{}: lower {} is above upper {}", limit.owner(), lower, upper));
    }
    limit.finish();
    joint.reach = std::max(std::abs(lower), std::abs(upper));
    if (needed) joint.limits = Limits{lower, upper, effort.value_or(0.0), limit.name_spot()};
  }

  void read_dynamics(Element& element, Joint& joint) {
    const XmlElement* xml = element.child("dynamics");
    if (xml == nullptr) return;
    Element dynamics(*xml, "the dynamics of " + element.owner(), messages_, false);
    joint.damping = not_negative(dynamics, "damping");
    joint.friction = not_negative(dynamics, "friction");
    dynamics.finish();
    if (xml->attribute("damping") != nullptr) joint.damping_spot = spot_of(*xml->attribute("damping"));
    if (xml->attribute("friction") != nullptr) joint.friction_spot = spot_of(*xml->attribute("friction"));
    if (xml->attribute("damping") == nullptr && xml->attribute("friction") == nullptr) {
      messages_.error(dynamics.name_spot(), "bad-urdf",
                      fmt::format("{} say neither damping nor friction", dynamics.owner()));
    }
    if (joint.has_coordinate()) return;
    if (joint.damping > 0.0) messages_.ignore("damping of joint", joint.name);
    if (joint.friction > 0.0) messages_.ignore("friction of joint", joint.name);
  }

  void check_calibration(Element& joint) {
    const XmlElement* xml = joint.child("calibration");
    if (xml == nullptr) return;
    Element calibration(*xml, "the calibration of " + joint.owner(), messages_, false);
    for (const char* key : {"rising", "falling", "reference_position"}) calibration.number(key, 0.0);
    calibration.finish();
    messages_.ignore("calibration");
  }

  void check_safety(Element& joint) {
    const XmlElement* xml = joint.child("safety_controller");
    if (xml == nullptr) return;
    Element safety(*xml, "the safety_controller of " + joint.owner(), messages_, false);
    safety.required_number("k_velocity");
    for (const char* key : {"k_position", "soft_lower_limit", "soft_upper_limit"}) safety.number(key, 0.0);
    safety.finish();
    messages_.ignore("safety_controller");
  }

  double not_negative(Element& element, const std::string& key) {
    const double value = element.number(key, 0.0);
    if (value >= 0.0) return value;
    messages_.error(spot_of(*element.xml().attribute(key)), "bad-urdf",
                    fmt::format("{} in {} must not be negative: {}", key, element.owner(), value));
    return 0.0;
  }

  void read_mimic(Element& element, Joint& joint) {
    const XmlElement* xml = element.child("mimic");
    if (xml == nullptr) return;
    Element mimic(*xml, "the mimic of " + element.owner(), messages_, true);
    Mimic read;
    const XmlAttribute* leader = mimic.require("joint");
    read.multiplier = mimic.number("multiplier", 1.0);
    read.offset = mimic.number("offset", 0.0);
    mimic.finish();
    const auto spot = [&](const char* key) {
      return xml->attribute(key) == nullptr ? mimic.name_spot() : spot_of(*xml->attribute(key));
    };
    read.spot = spot("joint");
    read.multiplier_spot = spot("multiplier");
    read.offset_spot = spot("offset");
    if (read.multiplier == 0.0) {
      messages_.error(read.multiplier_spot, "bad-urdf",
                      fmt::format("the multiplier of {} must not be 0", mimic.owner()));
    }
    if (leader == nullptr) return;
    read.joint = leader->value;
    joint.mimic = read;
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
      const auto [parent, child] = references_[i];
      if (parent != nullptr) joint.parent.link = names.find(parent->value, joint.parent.spot, messages_);
      if (child != nullptr) joint.child.link = names.find(child->value, joint.child.spot, messages_);
      robot_.ambiguous = robot_.ambiguous || joint.parent.link == no_link || joint.child.link == no_link;
      if (joint.parent.link != no_link && joint.parent.link == joint.child.link) {
        messages_.error(joint.child.spot, "bad-urdf",
                        fmt::format("joint '{}' joins link '{}' to itself", joint.name, child->value));
      }
    }
  }

  void resolve_mimics() {
    std::unordered_map<std::string, int> index;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      index.emplace(robot_.joints[i].name, static_cast<int>(i));
      names.push_back(robot_.joints[i].name);
    }
    for (Joint& joint : robot_.joints) {
      if (joint.mimic) resolve_mimic(joint, index, names);
    }
    report_mimic_cycles();
  }

  void resolve_mimic(Joint& joint, const std::unordered_map<std::string, int>& index,
                     const std::vector<std::string>& names) {
    Mimic& mimic = *joint.mimic;
    const auto has_coordinate = [](const Joint& j) {
      return j.type == JointType::revolute || j.type == JointType::prismatic;
    };
    const auto found = index.find(mimic.joint);
    if (found == index.end()) {
      messages_.error(mimic.spot, "bad-urdf",
                      fmt::format("joint '{}' is to mimic '{}', an unknown joint", joint.name, mimic.joint),
                      messages_.suggest(mimic.joint, names));
      return;
    }
    mimic.index = found->second;
    for (const Joint* one : {&joint, &robot_.joints[static_cast<std::size_t>(mimic.index)]}) {
      if (has_coordinate(*one)) continue;
      messages_.error(mimic.spot, "bad-urdf",
                      fmt::format("mimic needs joints with a coordinate; '{}' has none", one->name));
    }
  }

  /// Reports every joint of a cycle of followers; each joint is passed once.
  void report_mimic_cycles() {
    std::vector<int> round(robot_.joints.size(), 0);
    const auto leader = [&](int joint) {
      const auto& mimic = robot_.joints[static_cast<std::size_t>(joint)].mimic;
      return mimic ? mimic->index : -1;
    };
    for (int start = 0; start < static_cast<int>(robot_.joints.size()); ++start) {
      int at = start;
      while (at >= 0 && round[static_cast<std::size_t>(at)] == 0) {
        round[static_cast<std::size_t>(at)] = start + 1;
        at = leader(at);
      }
      if (at < 0 || round[static_cast<std::size_t>(at)] != start + 1) continue;
      const bool alone = leader(at) == at;
      for (int member = at;;) {
        const Joint& joint = robot_.joints[static_cast<std::size_t>(member)];
        messages_.error(joint.mimic->spot, "bad-urdf",
                        fmt::format("mimic: joint '{}' follows itself{}", joint.name, alone ? "" : " in a cycle"));
        member = leader(member);
        if (member == at) break;
      }
    }
  }

  // --- the rest --------------------------------------------------------------------------------------------------

  void finish() {
    for (const XmlElement& child : root_.children) note_other(child);
    for (const char* known : {"link", "joint"}) element_.pass_over(known);
    finish_known();
  }

  void note_other(const XmlElement& child) {
    if (child.name == "coupling") {
      messages_.warning(name_spot(child), "urdf-ignored",
                        fmt::format("the {} ties joints and is not read", label(child)),
                        "a gear in a side-car can say it");
    } else if (child.name == "transmission") {
      const XmlAttribute* name = child.attribute("name");
      messages_.ignore("transmission", name == nullptr ? "" : name->value);
    } else if (child.name == "material") {
      check_material(child, messages_);
    }
  }

  /// Unknown parts of the robot: those that are known to others are counted only.
  void finish_known() {
    static const std::vector<std::string> words = {"link", "joint", "loop", "loop_joint", "constraint"};
    for (const XmlAttribute& attribute : root_.attributes) {
      if (attribute.name != "name" && attribute.name != "version" && !attribute.name.starts_with("xmlns")) {
        messages_.ignore(fmt::format("attribute '{}' of 'robot'", attribute.name));
      }
    }
    for (const XmlElement& child : root_.children) {
      if (std::ranges::find(words, child.name) != words.end()) continue;
      if (child.name == "coupling" || child.name == "transmission" || is_loop_carrier(child)) continue;
      if (child.name.starts_with("xacro:")) {
        messages_.error(name_spot(child), "bad-urdf", fmt::format("'{}' is not expanded", child.name), {},
                        "this is a xacro file; expand it first");
        continue;
      }
      const bool known = std::ranges::find(other_parts, child.name) != std::end(other_parts);
      const std::string meant = known ? "" : misspelt(child.name, words);
      if (meant.empty()) {
        messages_.ignore(child.name);
      } else {
        messages_.error(name_spot(child), "bad-urdf", fmt::format("unknown element '{}' in the robot", child.name),
                        meant);
      }
    }
    if (!root_.text.empty()) {
      messages_.error({root_.text_place.line, root_.text_place.column, 1}, "bad-urdf", "unexpected text in the robot");
    }
  }

  const XmlElement& root_;
  Messages& messages_;
  Element element_;
  Robot robot_;
  std::vector<std::pair<const XmlAttribute*, const XmlAttribute*>> references_;  ///< parent and child of each joint
  std::unordered_map<std::string, int> link_lines_, joint_lines_;
};

}  // namespace

Robot read_robot(const XmlElement& root, Messages& messages) { return RobotReader(root, messages).read(); }

}  // namespace freeplay::urdf
