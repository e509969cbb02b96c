#include "io/urdf_document.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "io/number_text.h"
#include "io/urdf_element.h"
#include "io/urdf_inertia.h"
#include "io/urdf_names.h"
#include "io/urdf_plane.h"
#include "io/urdf_reader.h"
#include "io/urdf_referee.h"
#include "io/urdf_tree.h"

namespace freeplay::urdf {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Writes a planar robot as nodes of a document.
class Writer {
 public:
  Writer(const Robot& robot, const PlanarRobot& planar, Names& names, const Options& options, Document& document,
         const std::string* file, Messages& messages)
      : robot_(robot),
        planar_(planar),
        options_(options),
        document_(document),
        file_(file),
        messages_(messages),
        names_(names) {}

  Sections write() {
    write_bodies();
    joint_section_ = &map(robot_.spot);
    force_section_ = &map(robot_.spot);
    write_base();
    for (const bool loops : {false, true}) {
      for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
        if (robot_.joints[i].closes_loop == loops) write_joint(i);
      }
    }
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) write_mimic(i);
    append_frames();
    return {bodies_, joint_section_, force_section_, planar_.plane};
  }

 private:
  // --- nodes -----------------------------------------------------------------------------------------------------

  Node& node(Node::Kind kind, const Spot& spot) {
    Node& made = document_.add(kind, spot.line, spot.column);
    made.length = spot.length;
    made.file = file_;
    return made;
  }
  Node& map(const Spot& spot) { return node(Node::Kind::map, spot); }

  Node& scalar(std::string text, const Spot& spot) {
    Node& made = node(Node::Kind::scalar, spot);
    made.text = std::move(text);
    return made;
  }
  Node& number(double value, const Spot& spot) { return scalar(number_text(value), spot); }

  Node& list(std::vector<const Node*> items, const Spot& spot) {
    Node& made = node(Node::Kind::list, spot);
    made.items = std::move(items);
    return made;
  }
  Node& point(double x, double y, const Spot& spot) { return list({&number(x, spot), &number(y, spot)}, spot); }

  void put(Node& owner, const std::string& key, const Node& value, const Spot& spot) {
    Node& key_node = scalar(key, spot);
    key_node.foreign = true;
    owner.entries.push_back({&key_node, &value});
  }

  int body(int link) const { return link == world_link ? world_link : robot_.mounts[at(link)].body; }
  std::string body_name(int link) const {
    const int carrier = body(link);
    return carrier == world_link ? "ground" : names_.links[at(carrier)];
  }

  // --- bodies and frames -----------------------------------------------------------------------------------------

  void write_bodies() {
    bodies_ = &map(robot_.spot);
    body_nodes_.assign(robot_.links.size(), nullptr);
    frame_nodes_.assign(robot_.links.size() + 1, nullptr);
    const std::vector<PlanarBody> bodies = planar_bodies(robot_, planar_.plane);
    ground_ = &map(robot_.spot);
    put(*bodies_, "ground", *ground_, robot_.spot);
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      const Link& link = robot_.links[i];
      if (body(static_cast<int>(i)) != static_cast<int>(i)) continue;
      Node& entry = map(link.spot);
      body_nodes_[i] = &entry;
      put(entry, "mass", number(bodies[i].mass, link.mass_spot), link.mass_spot);
      put(entry, "inertia", number(bodies[i].inertia, link.inertia_spot), link.inertia_spot);
      if (bodies[i].com_x != 0.0 || bodies[i].com_y != 0.0) {
        put(entry, "com", point(bodies[i].com_x, bodies[i].com_y, link.mass_spot), link.mass_spot);
      }
      write_pose(static_cast<int>(i), entry);
      put(*bodies_, names_.links[i], entry, link.spot);
    }
    for (std::size_t i = 0; i < robot_.links.size(); ++i) write_link_frame(static_cast<int>(i));
  }

  /// A body that no joint of the tree holds gets its place at coordinates zero.
  void write_pose(int link, Node& entry) {
    const int parent = robot_.parent_joint[at(link)];
    const bool floats = parent < 0 ? options_.floating_base : robot_.joints[at(parent)].type == JointType::floating;
    if (!floats) return;
    const Spot& spot = robot_.links[at(link)].spot;
    const PlanarPose& pose = planar_.poses[at(link)];
    Node& value = map(spot);
    put(value, "position", point(pose.x, pose.y, spot), spot);
    put(value, "angle", number(pose.angle, spot), spot);
    put(entry, "pose", value, spot);
  }

  /// A link that is part of a body is a frame of it.
  void write_link_frame(int link) {
    const Link& source = robot_.links[at(link)];
    if (body(link) == link || (body(link) == world_link && names_.links[at(link)] == "ground")) return;
    add_frame(body(link), names_.links[at(link)], planar_.frames[at(link)], source.spot);
  }

  void add_frame(int body, const std::string& name, const PlanarPose& pose, const Spot& spot) {
    Node*& frames = frame_nodes_[body == world_link ? robot_.links.size() : at(body)];
    if (frames == nullptr) frames = &map(spot);
    Node& position = point(pose.x, pose.y, spot);
    if (pose.angle == 0.0) return put(*frames, name, position, spot);
    Node& frame = map(spot);
    put(frame, "position", position, spot);
    put(frame, "angle", number(pose.angle, spot), spot);
    put(*frames, name, frame, spot);
  }

  void append_frames() {
    for (std::size_t i = 0; i < frame_nodes_.size(); ++i) {
      if (frame_nodes_[i] == nullptr) continue;
      const bool of_ground = i == robot_.links.size();
      put(of_ground ? *ground_ : *body_nodes_[i], "frames", *frame_nodes_[i],
          of_ground ? robot_.spot : robot_.links[i].spot);
    }
  }

  // --- joints ----------------------------------------------------------------------------------------------------

  void write_base() {
    if (body(robot_.root) != robot_.root || options_.floating_base) return;
    const Spot& spot = robot_.links[at(robot_.root)].spot;
    Node& entry = map(spot);
    put(entry, "type", scalar("fixed", spot), spot);
    put(entry, "between", list({&scalar("ground", spot), &scalar(body_name(robot_.root), spot)}, spot), spot);
    put(*joint_section_, names_.add_joint("base", spot), entry, spot);
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
    if (joint.type == JointType::planar) {
      messages_.error(joint.type_spot, "type-space",
                      fmt::format("the type 'planar' of joint '{}' is for spatial models", joint.name), {},
                      "spatial models are not in this release");
      return;
    }
    const std::string& name = names_.joints[index];
    const PlanarJoint& planar = planar_.joints[index];
    add_frame(body(joint.parent.link), name, planar.first, joint.spot);
    add_frame(body(joint.child.link), name, planar.second, joint.spot);
    Node& entry = map(joint.spot);
    put(entry, "type", scalar(type_word(joint.type), joint.type_spot), joint.type_spot);
    put(entry, "between", ends(joint, name), joint.spot);
    put(*joint_section_, name, entry, joint.spot);
    if (joint.damping > 0.0 && joint.moves()) write_damper(joint, name, planar);
  }

  static const char* type_word(JointType type) {
    return type == JointType::revolute ? "revolute" : type == JointType::prismatic ? "prismatic" : "fixed";
  }

  const Node& ends(const Joint& joint, const std::string& first_frame, const std::string& second_frame) {
    return list({&scalar(body_name(joint.parent.link) + "/" + first_frame, joint.parent.spot),
                 &scalar(body_name(joint.child.link) + "/" + second_frame, joint.child.spot)},
                joint.spot);
  }
  const Node& ends(const Joint& joint, const std::string& frame) { return ends(joint, frame, frame); }

  void write_damper(const Joint& joint, const std::string& name, const PlanarJoint& planar) {
    const Spot& spot = joint.damping_spot;
    const std::string damper = name + "-damping";
    Node& entry = map(spot);
    put(entry, "type", scalar("spring-damper", spot), spot);
    if (joint.turns()) {
      put(entry, "kind", scalar("rotational", spot), spot);
      put(entry, "between", ends(joint, name), spot);
    } else {
      // The force acts along the line of the two origins: one of them stands back on the slide's own line, beyond its
      // reach, so that the line keeps its direction.
      const double back = 1.0 + joint.reach;
      PlanarPose anchor = planar.first;
      anchor.x -= back * std::cos(anchor.angle);
      anchor.y -= back * std::sin(anchor.angle);
      add_frame(body(joint.parent.link), damper, anchor, spot);
      put(entry, "kind", scalar("linear", spot), spot);
      put(entry, "between", ends(joint, damper, name), spot);
    }
    put(entry, "damping", number(joint.damping, spot), spot);
    put(*force_section_, damper, entry, spot);
  }

  void write_mimic(std::size_t index) {
    const Joint& joint = robot_.joints[index];
    if (!joint.mimic) return;
    const Mimic& mimic = *joint.mimic;
    // Coordinates of the plane: c = sign q for both joints, and q = multiplier q_leader + offset.
    const double own = planar_.joints[index].sign, leader = planar_.joints[at(mimic.index)].sign;
    Node& entry = map(mimic.spot);
    put(entry, "type", scalar("gear", mimic.spot), mimic.spot);
    put(entry, "of",
        list({&scalar(names_.joints[at(mimic.index)], mimic.spot), &scalar(names_.joints[index], joint.spot)},
             mimic.spot),
        mimic.spot);
    put(entry, "ratio", number(own * leader * mimic.multiplier, mimic.multiplier_spot), mimic.multiplier_spot);
    put(entry, "offset", number(own * mimic.offset + 0.0, mimic.offset_spot), mimic.offset_spot);
    put(*joint_section_, names_.add_joint(names_.joints[index] + "-mimic", mimic.spot), entry, mimic.spot);
  }

  const Robot& robot_;
  const PlanarRobot& planar_;
  const Options& options_;
  Document& document_;
  const std::string* file_;
  Messages& messages_;
  Names& names_;
  Node* bodies_ = nullptr;
  Node* ground_ = nullptr;
  Node* joint_section_ = nullptr;
  Node* force_section_ = nullptr;
  std::vector<Node*> body_nodes_, frame_nodes_;  ///< of each link; frames of ground last
};

/// The plane that was asked for, or the first in which the robot is planar, or the one that comes nearest.
PlanarRobot choose_plane(const Robot& robot, const Options& options) {
  if (options.plane) return project(robot, *options.plane);
  const auto faults = [](const PlanarRobot& seen) {
    return std::ranges::count_if(seen.joints, [](const PlanarJoint& joint) { return !joint.fault.empty(); });
  };
  PlanarRobot best = project(robot, Options::Plane::xy);
  for (const Options::Plane plane : {Options::Plane::xz, Options::Plane::yz}) {
    if (best.planar()) break;
    PlanarRobot next = project(robot, plane);
    if (faults(next) < faults(best)) best = std::move(next);
  }
  return best;
}

void report_snapping(const Robot& robot, const PlanarRobot& planar, Messages& messages) {
  constexpr double rounding = 1e-12;
  const auto worst = std::ranges::max_element(planar.joints, {}, &PlanarJoint::residual);
  if (worst != planar.joints.end() && worst->residual > rounding) {
    const Joint& joint = robot.joints[static_cast<std::size_t>(worst - planar.joints.begin())];
    messages.warning(
        worst->spot, "urdf-ignored",
        fmt::format("joints are snapped to the plane {}; the largest residual is {:.3g} rad, of joint '{}'",
                    plane_word(planar.plane), worst->residual, joint.name));
  }
  for (const std::string& name : planar.tilted_frames) messages.ignore("tilt of the frame", name);
}

void report_default_axes(const Robot& robot, Messages& messages) {
  for (const Joint& joint : robot.joints) {
    const bool needs = joint.type == JointType::revolute || joint.type == JointType::prismatic;
    if (!needs || joint.axis_given) continue;
    messages.warning(joint.element, "missing-key", fmt::format("joint '{}' has no axis; URDF takes 1 0 0", joint.name));
  }
}

std::optional<Sections> read_sections(const XmlElement& root, const std::string* file_name, const Options& options,
                                      Document& document, Messages& messages) {
  Robot robot = read_robot(root, messages);
  if (root.name != "robot") return std::nullopt;
  build_tree(robot, options, messages);
  Names names(robot, messages);
  if (!messages.failed()) ask_referee(root, messages);
  // What could not be read has been replaced by a guess, which says nothing about the plane.
  if (robot.mounts.empty() || (!robot.places_known && !options.plane)) return std::nullopt;
  const PlanarRobot planar = choose_plane(robot, options);
  robot.mounts = planar.mounts;
  const Eigen::Vector3d normal = plane_axes(planar.plane).row(2);
  check_inertia(robot, options, planar.planar() || !robot.places_known, normal, messages);
  if (robot.places_known && !planar.planar()) report_not_planar(robot, planar, messages);
  if (messages.failed()) return std::nullopt;
  report_default_axes(robot, messages);
  report_snapping(robot, planar, messages);
  const Sections sections = Writer(robot, planar, names, options, document, file_name, messages).write();
  if (messages.failed()) return std::nullopt;
  return sections;
}

}  // namespace

std::optional<Sections> add_sections(const std::string& text, const std::string* file_name, const Options& options,
                                     Document& document, Diagnostics& diagnostics) {
  const std::optional<XmlElement> root = parse_xml(text, *file_name, "bad-urdf", diagnostics);
  if (!root) return std::nullopt;
  Messages messages(*file_name, diagnostics);
  std::optional<Sections> sections = read_sections(*root, file_name, options, document, messages);
  messages.report_ignored(name_spot(*root));
  return sections;
}

}  // namespace freeplay::urdf
