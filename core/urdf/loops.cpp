#include "urdf/loops.h"

#include <fmt/format.h>

#include "urdf/reference.h"
#include "urdf/text_value.h"

namespace freeplay::urdf {
namespace {

class LoopReader {
 public:
  LoopReader(Robot& robot, Messages& messages) : robot_(robot), messages_(messages), links_(robot.links) {
    for (const Joint& joint : robot.joints) lines_.emplace(joint.name, joint.spot.line);
  }

  /// <constraint>, <loop>, <loop_joint>.
  void read_element(XmlElement& xml) {
    Joint joint;
    Element element(xml, owner_of(xml), messages_, false);
    read_head(element, joint);
    read_end(element, {"parent", "predecessor", "link1"}, {"parent_origin", "predecessor_origin", "origin"},
             joint.parent);
    read_end(element, {"child", "successor", "link2"}, {"child_origin", "successor_origin"}, joint.child);
    read_axes(element, joint);
    for (const char* known : {"limit", "dynamics"}) element.pass_over(known);
    element.finish();
    add(std::move(joint));
  }

  /// A joint of SDF inside of <gazebo>.
  void read_sdf(XmlElement& xml) {
    Joint joint;
    Element element(xml, owner_of(xml), messages_, false);
    read_head(element, joint);
    joint.closed_at_zero = true;
    joint.parent = read_sdf_end(element, "parent");
    joint.child = read_sdf_end(element, "child");
    if (XmlElement* pose = element.child("pose")) read_sdf_pose(*pose, joint.child);
    if (XmlElement* axis = element.child("axis")) read_sdf_axis(*axis, joint);
    for (const char* known : {"physics", "sensor"}) element.pass_over(known);
    element.finish();
    add(std::move(joint));
  }

 private:
  static std::string owner_of(const XmlElement& xml) {
    const XmlAttribute* name = xml.FindAttribute("name");
    return name == nullptr ? fmt::format("a {}", xml.Name()) : fmt::format("{} '{}'", xml.Name(), name->Value());
  }

  void add(Joint joint) {
    joint.closes_loop = true;
    const auto [known, fresh] = lines_.emplace(joint.name, joint.spot.line);
    if (!fresh) {
      messages_.error(joint.spot, "bad-urdf",
                      fmt::format("the joint '{}' exists already: first on line {}", joint.name, known->second));
    }
    if (joint.parent.link != no_link && joint.parent.link == joint.child.link) {
      messages_.error(joint.child.spot, "bad-urdf", fmt::format("'{}' joins a link to itself", joint.name));
    }
    robot_.joints.push_back(std::move(joint));
  }

  void read_head(Element& element, Joint& joint) {
    joint.element = element.begin_spot();
    joint.spot = joint.axis_spot = element.name_spot();
    if (const XmlAttribute* name = element.require("name")) {
      joint.name = name->Value();
      joint.spot = spot_of(element.xml(), "name");
    }
    const XmlAttribute* type = element.require("type");
    joint.type_spot = type == nullptr ? joint.spot : spot_of(element.xml(), *type);
    if (type != nullptr) joint.type = read_type(type->Value(), joint.type_spot, element.owner());
  }

  JointType read_type(const std::string& type, const Spot& spot, const std::string& owner) {
    const std::vector<std::string> words = {"revolute", "continuous", "prismatic", "fixed"};
    constexpr JointType types[] = {JointType::revolute, JointType::revolute, JointType::prismatic, JointType::fixed};
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (type == words[i]) return types[i];
    }
    messages_.error(spot, "bad-urdf", fmt::format("the type '{}' of {} has no counterpart here", type, owner),
                    messages_.suggest(type, words), "types: revolute, continuous, prismatic, fixed");
    return JointType::fixed;
  }

  static XmlElement* first_child(Element& element, const std::vector<std::string>& names) {
    XmlElement* found = nullptr;
    for (const std::string& name : names) {
      XmlElement* child = element.xml().FirstChildElement(name.c_str());
      // A dialect's own words stay unknown to the others, so that a misspelt one is seen.
      if (child == nullptr) continue;
      element.child(name);
      if (found == nullptr) found = child;
    }
    return found;
  }

  void read_end(Element& element, const std::vector<std::string>& names, const std::vector<std::string>& origins,
                End& end) {
    XmlElement* xml = first_child(element, names);
    end.spot = end.frame_spot = element.name_spot();
    if (xml == nullptr) {
      messages_.error(
          end.spot, "bad-urdf",
          fmt::format("the element '{}' of {} is missing", words_for(element.xml().Name(), names), element.owner()));
      return;
    }
    Element side(*xml, fmt::format("the {} of {}", xml->Name(), element.owner()), messages_, true);
    if (const XmlAttribute* link = side.require("link")) {
      end.spot = spot_of(*xml, *link);
      end.link = links_.find(link->Value(), end.spot, messages_);
    }
    const Eigen::Isometry3d own = read_pose(side);
    end.frame = own * read_origin(side, messages_, &end.frame_spot);
    side.finish();
    if (XmlElement* origin = first_child(element, origins)) {
      Element frame(*origin, fmt::format("the {} of {}", origin->Name(), element.owner()), messages_, true);
      end.frame = end.frame * read_pose(frame);
      end.frame_spot = frame.name_spot();
      frame.finish();
    }
  }

  static std::string words_for(const std::string& dialect, const std::vector<std::string>& names) {
    return dialect == "loop" ? names[1] : dialect == "loop_joint" ? names[2] : names[0];
  }

  void read_axes(Element& element, Joint& joint) {
    XmlElement* axis = first_child(element, {"axis", "parent_axis"});
    XmlElement* other = first_child(element, {"child_axis"});
    if (joint.type == JointType::fixed) return;
    if (axis != nullptr) {
      joint.axis_given = true;
      joint.axis =
          read_axis(*axis, fmt::format("the {} of {}", axis->Name(), element.owner()), messages_, joint.axis_spot);
    }
    if (other == nullptr) return;
    // The frames of both ends are to share the axis; one that does not makes the joint another one.
    Spot spot;
    const Eigen::Vector3d second =
        read_axis(*other, fmt::format("the {} of {}", other->Name(), element.owner()), messages_, spot);
    if (second.cross(joint.axis).norm() > 1e-5 || second.dot(joint.axis) < 0.0) {
      messages_.error(spot, "bad-urdf", fmt::format("both axes of {} must have the same numbers", element.owner()), {},
                      "turn the origin of the child instead");
    }
  }

  // --- SDF -------------------------------------------------------------------------------------------------------

  End read_sdf_end(Element& element, const char* side) {
    End end;
    end.spot = end.frame_spot = element.name_spot();
    XmlElement* xml = element.child(side);
    if (xml == nullptr) {
      messages_.error(end.spot, "bad-urdf", fmt::format("the element '{}' of {} is missing", side, element.owner()));
      return end;
    }
    end.spot = end.frame_spot = whole_text_spot(*xml);
    const std::string name = trimmed_text(*xml);
    // In SDF `world` is there without being declared.
    end.link = name == "world" && !links_.knows(name) ? world_link : links_.find(name, end.spot, messages_);
    return end;
  }

  void read_sdf_pose(const XmlElement& xml, End& child) {
    for (const XmlAttribute* attribute = xml.FirstAttribute(); attribute != nullptr; attribute = attribute->Next()) {
      const std::string_view name = attribute->Name(), value = attribute->Value();
      if (value.empty() || name == "degrees" || name == "rotation_format") continue;
      messages_.error(spot_of(xml, *attribute), "bad-urdf",
                      fmt::format("the attribute '{}' of a pose is not read: a pose is relative to the child", name));
    }
    child.frame = text_pose(xml, messages_);
  }

  void read_sdf_axis(XmlElement& xml, Joint& joint) {
    Element axis(xml, fmt::format("the axis of '{}'", joint.name), messages_, false);
    XmlElement* xyz = axis.child("xyz");
    XmlElement* frame = axis.child("use_parent_model_frame");
    for (const char* known : {"limit", "dynamics", "initial_position"}) axis.pass_over(known);
    axis.finish();
    if (xyz == nullptr || joint.type == JointType::fixed) return;
    joint.axis_given = true;
    joint.axis_spot = whole_text_spot(*xyz);
    const XmlAttribute* expressed = xyz->FindAttribute("expressed_in");
    const std::string_view axes = expressed == nullptr ? "" : expressed->Value();
    if (!axes.empty() && axes != "__model__") {
      messages_.error(spot_of(*xyz, *expressed), "bad-urdf",
                      fmt::format("the axis of '{}' may be expressed in __model__ only", joint.name));
    }
    const std::string word = frame == nullptr ? std::string() : trimmed_text(*frame);
    joint.axis_in_world = word == "1" || word == "true" || axes == "__model__";
    const std::vector<double> numbers = text_numbers(*xyz, 3, messages_);
    if (numbers.empty()) return;
    joint.axis = unit_axis({numbers[0], numbers[1], numbers[2]}, joint.axis_spot,
                           fmt::format("the axis of '{}'", joint.name), messages_);
  }

  Robot& robot_;
  Messages& messages_;
  LinkNames links_;
  std::unordered_map<std::string, int> lines_;  ///< of joints by name
};

}  // namespace

bool is_loop_carrier(const XmlElement& element) {
  return std::string_view(element.Name()) == "gazebo" && element.FirstChildElement("joint") != nullptr;
}

void read_loops(XmlElement& root, Robot& robot, Messages& messages) {
  LoopReader reader(robot, messages);
  for (XmlElement& child : XmlChildren(root)) {
    const std::string_view name = child.Name();
    if (name == "constraint" || name == "loop" || name == "loop_joint") reader.read_element(child);
    if (!is_loop_carrier(child)) continue;
    for (XmlElement& part : XmlChildren(child)) {
      if (std::string_view(part.Name()) == "joint") {
        reader.read_sdf(part);
      } else {
        messages.ignore(fmt::format("element '{}' of 'gazebo'", part.Name()));
      }
    }
  }
}

}  // namespace freeplay::urdf
