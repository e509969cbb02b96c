#include "urdf/sections.h"

#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay::urdf {
namespace {

/// Writes a robot as nodes of a document.
class Writer {
 public:
  Writer(const Robot& robot, View& view, Names& names, const Options& options, Nodes& nodes, Messages& messages)
      : robot_(robot), options_(options), view_(view), nodes_(nodes), messages_(messages), names_(names) {}

  Sections write(std::optional<Options::Plane> plane) {
    planar_ = plane.has_value();
    write_bodies();
    joint_section_ = &nodes_.map(robot_.spot);
    force_section_ = &nodes_.map(robot_.spot);
    write_base();
    for (const bool loops : {false, true}) {
      for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
        if (robot_.joints[i].closes_loop == loops) write_joint(i);
      }
    }
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) write_mimic(i);
    append_frames();
    return {bodies_, joint_section_, force_section_, plane, nullptr};
  }

 private:
  int body(int link) const { return link == world_link ? world_link : robot_.mounts[at(link)].body; }
  std::string body_name(int link) const {
    const int carrier = body(link);
    return carrier == world_link ? "ground" : names_.links[at(carrier)];
  }

  // --- bodies and frames -----------------------------------------------------------------------------------------

  void write_bodies() {
    bodies_ = &nodes_.map(robot_.spot);
    body_nodes_.assign(robot_.links.size(), nullptr);
    frame_nodes_.assign(robot_.links.size() + 1, nullptr);
    ground_ = &nodes_.map(robot_.spot);
    nodes_.put(*bodies_, "ground", *ground_, robot_.spot);
    for (int i = 0; i < static_cast<int>(robot_.links.size()); ++i) {
      const Link& link = robot_.links[at(i)];
      if (body(i) != i) continue;
      Node& entry = nodes_.map(link.spot);
      body_nodes_[at(i)] = &entry;
      nodes_.put(entry, "mass", nodes_.number(view_.mass(i), link.mass_spot), link.mass_spot);
      nodes_.put(entry, "inertia", view_.inertia(i), link.inertia_spot);
      if (const Node* com = view_.com(i)) nodes_.put(entry, "com", *com, link.mass_spot);
      if (floats(i)) nodes_.put(entry, "pose", view_.pose(i), link.spot);
      nodes_.put(*bodies_, names_.links[at(i)], entry, link.spot);
    }
    for (int i = 0; i < static_cast<int>(robot_.links.size()); ++i) write_link_frame(i);
  }

  /// A body that no joint of the tree can place gets its place at coordinates zero.
  bool floats(int link) const {
    const int parent = robot_.parent_joint[at(link)];
    if (parent < 0) return options_.floating_base;
    const JointType type = robot_.joints[at(parent)].type;
    return type == JointType::floating || type == JointType::planar;
  }

  /// A link that is part of a body is a frame of it.
  void write_link_frame(int link) {
    const Link& source = robot_.links[at(link)];
    if (body(link) == link || (body(link) == world_link && names_.links[at(link)] == "ground")) return;
    add_frame(body(link), names_.links[at(link)], view_.link_frame(link), source.spot);
  }

  void add_frame(int body, const std::string& name, const Node& frame, const Spot& spot) {
    Node*& frames = frame_nodes_[body == world_link ? robot_.links.size() : at(body)];
    if (frames == nullptr) frames = &nodes_.map(spot);
    nodes_.put(*frames, name, frame, spot);
  }

  void append_frames() {
    for (std::size_t i = 0; i < frame_nodes_.size(); ++i) {
      if (frame_nodes_[i] == nullptr) continue;
      const bool of_ground = i == robot_.links.size();
      nodes_.put(of_ground ? *ground_ : *body_nodes_[i], "frames", *frame_nodes_[i],
                 of_ground ? robot_.spot : robot_.links[i].spot);
    }
  }

  // --- joints ----------------------------------------------------------------------------------------------------

  void write_base() {
    if (body(robot_.root) != robot_.root || options_.floating_base) return;
    const Spot& spot = robot_.links[at(robot_.root)].spot;
    Node& entry = nodes_.map(spot);
    nodes_.put(entry, "type", nodes_.scalar("fixed", spot), spot);
    const Node& base = nodes_.scalar(body_name(robot_.root), spot);
    nodes_.put(entry, "between", nodes_.list({&nodes_.scalar("ground", spot), &base}, spot), spot);
    nodes_.put(*joint_section_, names_.add_joint("base", spot), entry, spot);
  }

  /// A joint that only says where a mere frame stands is no joint here.
  bool is_written(const Joint& joint) const {
    if (joint.closes_loop) return true;
    return body(joint.child.link) == joint.child.link && joint.type != JointType::floating;
  }

  void write_joint(std::size_t index) {
    const Joint& joint = robot_.joints[index];
    if (!is_written(joint)) return;
    if (body(joint.parent.link) == body(joint.child.link)) {
      messages_.error(joint.child.spot, "bad-urdf", fmt::format("joint '{}' joins two parts of one body", joint.name));
      return;
    }
    const std::string& name = names_.joints[index];
    const int number = static_cast<int>(index);
    add_frame(body(joint.parent.link), name, view_.joint_frame(number, Side::parent), joint.spot);
    add_frame(body(joint.child.link), name, view_.joint_frame(number, Side::child), joint.spot);
    Node& entry = nodes_.map(joint.spot);
    nodes_.put(entry, "type", nodes_.scalar(type_word(joint.type), joint.type_spot), joint.type_spot);
    nodes_.put(entry, "between", ends(joint, name, name), joint.spot);
    if (const Node* axis = view_.axis(number)) nodes_.put(entry, "axis", *axis, joint.axis_spot);
    if (joint.type == JointType::screw) {
      nodes_.put(entry, "lead", nodes_.number(joint.lead, joint.axis_spot), joint.axis_spot);
    }
    nodes_.put(*joint_section_, name, entry, joint.spot);
    if ((joint.damping > 0.0 || joint.stiffness > 0.0) && joint.has_coordinate()) write_spring_damper(number);
    if (joint.friction > 0.0 && joint.has_coordinate()) write_friction(number);
    if (joint.limits && options_.stops) write_stop(number);
  }

  const char* type_word(JointType type) const {
    switch (type) {
      case JointType::revolute:
        return "revolute";
      case JointType::prismatic:
        return "prismatic";
      case JointType::planar:
        return "planar";
      case JointType::spherical:  // in the plane a point that is held is a pin
        return planar_ ? "revolute" : "spherical";
      case JointType::universal:
        return "universal";
      case JointType::cylindrical:
        return "cylindrical";
      case JointType::screw:
        return "screw";
      default:
        return "fixed";
    }
  }

  const Node& ends(const Joint& joint, const std::string& first_frame, const std::string& second_frame) {
    return nodes_.list({&nodes_.scalar(body_name(joint.parent.link) + "/" + first_frame, joint.parent.spot),
                        &nodes_.scalar(body_name(joint.child.link) + "/" + second_frame, joint.child.spot)},
                       joint.spot);
  }

  /// A spring is slack where the file says; `-damping` is one without stiffness.
  void write_spring_damper(int index) {
    const Joint& joint = robot_.joints[at(index)];
    const bool has_spring = joint.stiffness > 0.0;
    const Spot& spot = has_spring ? joint.stiffness_spot : joint.damping_spot;
    const std::string name = names_.joints[at(index)] + (has_spring ? "-spring" : "-damping");
    Node& entry = nodes_.map(spot);
    nodes_.put(entry, "type", nodes_.scalar("spring-damper", spot), spot);
    nodes_.put(entry, "kind", nodes_.scalar(joint.turns() ? "rotational" : "linear", spot), spot);
    nodes_.put(entry, "between", joint.turns() ? axis_ends(index) : line_ends(index, name), spot);
    if (has_spring) {
      nodes_.put(entry, "stiffness", nodes_.number(joint.stiffness, spot), spot);
      const double slack =
          joint.turns() ? view_.sign(index) * joint.slack_at + 0.0 : 1.0 + joint.reach + joint.slack_at;
      nodes_.put(entry, joint.turns() ? "free_angle" : "free_length", nodes_.number(slack, spot), spot);
    }
    if (joint.damping > 0.0) {
      nodes_.put(entry, "damping", nodes_.number(joint.damping, joint.damping_spot), joint.damping_spot);
    }
    nodes_.put(*force_section_, name, entry, spot);
  }

  void write_friction(int index) {
    const Joint& joint = robot_.joints[at(index)];
    Node& entry = axis_force(index, "joint-friction", "-friction", joint.friction_spot);
    nodes_.put(entry, "friction", nodes_.number(joint.friction, joint.friction_spot), joint.friction_spot);
  }

  /// Where the file says no stiffness, the stops give way by 1 mm or 0.01 rad under the largest effort of the joint.
  void write_stop(int index) {
    const Joint& joint = robot_.joints[at(index)];
    const Limits& limits = *joint.limits;
    const Spot& spot = limits.spot;
    const double give = joint.turns() ? 0.01 : 1e-3, effort = limits.effort > 0.0 ? limits.effort : 10.0;
    const bool turned = view_.sign(index) < 0.0;
    Node& entry = axis_force(index, "joint-stop", "-stop", spot);
    nodes_.put(entry, "lower", nodes_.number(turned ? -limits.upper + 0.0 : limits.lower, spot), spot);
    nodes_.put(entry, "upper", nodes_.number(turned ? -limits.lower + 0.0 : limits.upper, spot), spot);
    const double stiffness = limits.stiffness > 0.0 ? limits.stiffness : effort / give;
    nodes_.put(entry, "stiffness", nodes_.number(stiffness, spot), spot);
  }

  /// An entry of `forces` that acts on the coordinate of a joint.
  Node& axis_force(int index, const char* type, const char* suffix, const Spot& spot) {
    Node& entry = nodes_.map(spot);
    nodes_.put(entry, "type", nodes_.scalar(type, spot), spot);
    nodes_.put(entry, "kind", nodes_.scalar(robot_.joints[at(index)].turns() ? "rotational" : "linear", spot), spot);
    nodes_.put(entry, "between", axis_ends(index), spot);
    nodes_.put(*force_section_, names_.joints[at(index)] + suffix, entry, spot);
    return entry;
  }

  /// Frames whose own axis is that of the joint: the joint's, or a pair that all its forces share.
  const Node& axis_ends(int index) {
    const Joint& joint = robot_.joints[at(index)];
    std::string& frame = axis_frames_.try_emplace(index).first->second;
    if (!frame.empty()) return ends(joint, frame, frame);
    frame = names_.joints[at(index)];
    const Node* first = view_.axis_frame(index, Side::parent);
    const Node* second = view_.axis_frame(index, Side::child);
    if (first != nullptr && second != nullptr) {
      frame = names_.fresh_frame(frame + "-axis");
      add_frame(body(joint.parent.link), frame, *first, joint.axis_spot);
      add_frame(body(joint.child.link), frame, *second, joint.axis_spot);
    }
    return ends(joint, frame, frame);
  }

  /// A linear force acts along the line of two origins: one of them stands back on the slide's own line, beyond its
  /// reach, so that the line keeps its direction.
  const Node& line_ends(int index, const std::string& name) {
    const Joint& joint = robot_.joints[at(index)];
    const std::string frame = names_.fresh_frame(name);
    add_frame(body(joint.parent.link), frame, view_.set_back(index, 1.0 + joint.reach), joint.damping_spot);
    return ends(joint, frame, names_.joints[at(index)]);
  }

  void write_mimic(std::size_t index) {
    const Joint& joint = robot_.joints[index];
    if (!joint.mimic) return;
    const Mimic& mimic = *joint.mimic;
    // Coordinates of the model: c = sign q for both joints, and q = multiplier q_leader + offset.
    const double own = view_.sign(static_cast<int>(index)), leader = view_.sign(mimic.index);
    Node& entry = nodes_.map(mimic.spot);
    nodes_.put(entry, "type", nodes_.scalar("gear", mimic.spot), mimic.spot);
    const Node& first = nodes_.scalar(names_.joints[at(mimic.index)], mimic.spot);
    nodes_.put(entry, "of", nodes_.list({&first, &nodes_.scalar(names_.joints[index], joint.spot)}, mimic.spot),
               mimic.spot);
    nodes_.put(entry, "ratio", nodes_.number(own * leader * mimic.multiplier, mimic.multiplier_spot),
               mimic.multiplier_spot);
    nodes_.put(entry, "offset", nodes_.number(own * mimic.offset + 0.0, mimic.offset_spot), mimic.offset_spot);
    nodes_.put(*joint_section_, names_.add_joint(names_.joints[index] + "-mimic", mimic.spot), entry, mimic.spot);
  }

  const Robot& robot_;
  const Options& options_;
  View& view_;
  Nodes& nodes_;
  Messages& messages_;
  Names& names_;
  Node* bodies_ = nullptr;
  Node* ground_ = nullptr;
  Node* joint_section_ = nullptr;
  Node* force_section_ = nullptr;
  bool planar_ = false;
  std::vector<Node*> body_nodes_, frame_nodes_;  ///< of each link; frames of ground last
  std::map<int, std::string> axis_frames_;       ///< of joints: frames whose own axis is the joint's
};

}  // namespace

Sections write_sections(const Robot& robot, View& view, std::optional<Options::Plane> plane, Names& names,
                        const Options& options, Nodes& nodes, Messages& messages) {
  return Writer(robot, view, names, options, nodes, messages).write(plane);
}

}  // namespace freeplay::urdf
