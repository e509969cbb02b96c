#include "mjcf/equality.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/index.h"
#include "mjcf/pose.h"

namespace freeplay::mjcf {
namespace {

using urdf::End;
using urdf::JointType;

class EqualityReader {
 public:
  EqualityReader(World& world, const Settings& settings, const Defaults& defaults, Messages& messages)
      : world_(world), settings_(settings), defaults_(defaults), messages_(messages) {
    for (const auto& [name, link] : world.bodies) body_names_.push_back(name);
    for (const auto& [name, site] : world.sites) site_names_.push_back(name);
    for (std::size_t i = 0; i < world.robot.joints.size(); ++i) {
      joints_.emplace(world.robot.joints[i].name, i);
      joint_names_.push_back(world.robot.joints[i].name);
    }
  }

  void read(XmlElement& xml) {
    defaults_.complete(xml, "equality", {});
    const char* name = xml.Attribute("name");
    const std::string owner = fmt::format("{} '{}'", xml.Name(), name == nullptr ? "" : name);
    Element element(xml, name == nullptr ? fmt::format("a {}", xml.Name()) : owner, messages_, false);
    for (const char* known : {"name", "class", "active"}) element.find(known);
    const bool active = choice(element, "active", {"false", "true"}, 1, messages_) == 1;
    if (!active || !settings_.has_equalities)
      return messages_.ignore("switched-off equality", name ? name : xml.Name());
    if (urdf::is(xml, "connect")) return close_loop(element, JointType::spherical);
    if (urdf::is(xml, "weld")) return close_loop(element, JointType::fixed);
    if (urdf::is(xml, "joint")) return couple(element);
    messages_.warning(name_spot(xml), "urdf-ignored", fmt::format("the equality {} ties parts and is not read", owner),
                      "a joint in a side-car may say it");
  }

 private:
  // --- connect and weld ------------------------------------------------------------------------------------------

  void close_loop(Element& element, JointType type) {
    urdf::Joint joint;
    joint.type = type;
    joint.closes_loop = joint.axis_given = true;
    joint.spot = joint.axis_spot = spot_of(element.xml(), "name");
    joint.element = joint.type_spot = element.begin_spot();
    const int errors = messages_.errors();
    if (element.find("site1") != nullptr || element.find("site2") != nullptr) {
      joint.parent = site_end(element, "site1");
      joint.child = site_end(element, "site2");
      // Only the points count of a connect; its frames have the axes of the bodies.
      if (type == JointType::spherical)
        joint.parent.frame.linear() = joint.child.frame.linear() = Eigen::Matrix3d::Identity();
    } else {
      joint.parent = body_end(element, "body1", true);
      joint.child = body_end(element, "body2", false);
      place(element, joint, messages_.errors() == errors);
    }
    for (const char* rigid : {"anchor", "relpose"}) element.find(rigid);
    element.finish();
    if (messages_.errors() != errors) {
      world_.robot.ambiguous = true;
      return;
    }
    if (joint.parent.link == joint.child.link) {
      messages_.error(joint.spot, "bad-urdf", fmt::format("{} joins a body to itself", element.owner()));
    }
    name_loop(element, joint);
    world_.robot.joints.push_back(std::move(joint));
  }

  void name_loop(const Element& element, urdf::Joint& joint) {
    const char* name = element.xml().Attribute("name");
    const auto link_name = [&](const End& end) { return world_.robot.links[at(end.link)].name; };
    const std::string own = name != nullptr ? std::string(name)
                                            : fmt::format("{}-{}-{}", element.xml().Name(), link_name(joint.parent),
                                                          link_name(joint.child));
    joint.name = world_.names.fresh(own);
    if (joint.name == own || name == nullptr) return;
    messages_.warning(joint.spot, "urdf-renamed",
                      fmt::format("the {} is called '{}' here", element.owner(), joint.name));
  }

  End site_end(Element& element, const char* key) {
    const XmlAttribute* name = element.require(key);
    if (name == nullptr) return {};
    const Spot spot = spot_of(element.xml(), *name);
    const auto found = world_.sites.find(name->Value());
    if (found != world_.sites.end()) return {found->second.link, found->second.pose, spot, spot};
    messages_.error(spot, "bad-urdf", fmt::format("unknown site '{}'", name->Value()),
                    messages_.suggest(name->Value(), site_names_));
    return {};
  }

  /// Without a second body the first is held to the world.
  End body_end(Element& element, const char* key, bool required) {
    const XmlAttribute* name = required ? element.require(key) : element.find(key);
    End end;
    end.spot = end.frame_spot = element.name_spot();
    if (name == nullptr && !required) end.link = 0;
    if (name == nullptr) return end;
    end.spot = end.frame_spot = spot_of(element.xml(), *name);
    const auto found = world_.bodies.find(name->Value());
    if (found == world_.bodies.end()) {
      messages_.error(end.spot, "bad-urdf", fmt::format("unknown body '{}'", name->Value()),
                      messages_.suggest(name->Value(), body_names_));
    } else {
      end.link = found->second;
    }
    return end;
  }

  /// Both ends stand where the file draws them, but for a `relpose`.
  void place(Element& element, urdf::Joint& joint, bool known) {
    const bool welded = joint.type == JointType::fixed;
    const auto anchor = element.vector("anchor");
    if (!welded && element.find("anchor") == nullptr) element.require("anchor");
    const std::vector<double> pose = welded ? element.numbers("relpose", 7) : std::vector<double>();
    if (!known) return;
    if (!welded) joint.parent.frame.translation() = anchor.value_or(Eigen::Vector3d::Zero());
    const Eigen::Isometry3d between =
        urdf::inverse_pose(world_.poses[at(joint.child.link)]) * world_.poses[at(joint.parent.link)];
    if (!welded) {
      joint.child.frame.translation() = between * joint.parent.frame.translation();
      return;
    }
    joint.parent.frame = urdf::inverse_pose(between);
    if (pose.empty() || std::all_of(pose.begin() + 3, pose.end(), [](double part) { return part == 0.0; })) return;
    joint.parent.frame.translation() << pose[0], pose[1], pose[2];
    joint.parent.frame.linear() =
        turn_of(pose.data() + 3, spot_of(element.xml(), "relpose"), element.owner(), messages_);
  }

  // --- joint -----------------------------------------------------------------------------------------------------

  void couple(Element& element) {
    const XmlElement& xml = element.xml();
    std::vector<double> factors = element.numbers("polycoef", 1, 5, "0 1");
    if (element.find("polycoef") == nullptr) factors = {0.0, 1.0};
    factors.resize(5, 0.0);
    urdf::Joint* follower = joint_of(element, "joint1");
    const bool plain = factors[1] != 0.0 && factors[2] == 0.0 && factors[3] == 0.0 && factors[4] == 0.0;
    if (element.find("joint2") == nullptr || !plain) {
      messages_.warning(name_spot(xml), "urdf-ignored",
                        fmt::format("the equality {} is not read: only two joints in proportion are", element.owner()));
      return element.finish();
    }
    urdf::Joint* leader = joint_of(element, "joint2");
    element.finish();
    if (follower == nullptr || leader == nullptr) return;
    if (follower->mimic) {
      messages_.error(spot_of(xml, "joint1"), "bad-urdf",
                      fmt::format("joint '{}' follows another already", follower->name));
      return;
    }
    const Spot spot = spot_of(xml, "joint2"), numbers = spot_of(xml, "polycoef");
    follower->mimic = urdf::Mimic{leader->name, -1, factors[1], factors[0], spot, numbers, numbers};
  }

  urdf::Joint* joint_of(Element& element, const char* key) {
    const XmlAttribute* name = element.require(key);
    if (name == nullptr) return nullptr;
    if (const auto found = joints_.find(name->Value()); found != joints_.end()) {
      return &world_.robot.joints[found->second];
    }
    messages_.error(spot_of(element.xml(), *name), "bad-urdf", fmt::format("unknown joint '{}'", name->Value()),
                    messages_.suggest(name->Value(), joint_names_));
    return nullptr;
  }

  World& world_;
  const Settings& settings_;
  const Defaults& defaults_;
  Messages& messages_;
  std::map<std::string, std::size_t> joints_;  ///< of the tree, by name
  std::vector<std::string> body_names_, site_names_, joint_names_;
};

}  // namespace

void read_equalities(XmlElement& root, World& world, const Settings& settings, const Defaults& defaults,
                     Messages& messages) {
  EqualityReader reader(world, settings, defaults, messages);
  for (XmlElement& section : XmlChildren(root)) {
    if (!urdf::is(section, "equality")) continue;
    for (XmlElement& child : XmlChildren(section)) {
      if (!refuse_unexpanded(child, messages)) reader.read(child);
    }
  }
}

}  // namespace freeplay::mjcf
