#include "mjcf/world.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/index.h"
#include "mjcf/geom.h"
#include "mjcf/inertia.h"
#include "mjcf/pose.h"

namespace freeplay::mjcf {
namespace {

/// A part of a body with the frame and the class that enclose it.
struct Part {
  XmlElement* xml;
  Eigen::Isometry3d frame;
  std::string standard_class;
};

/// What stands in a body, by kind and in file order.
struct Content {
  std::vector<Part> joints, geoms, sites, bodies;
  XmlElement* inertial = nullptr;
};

class WorldReader {
 public:
  WorldReader(const Settings& settings, const Defaults& defaults, Messages& messages)
      : settings_(settings), defaults_(defaults), messages_(messages) {}

  World read(XmlElement& root) {
    robot().spot = name_spot(root);
    for (const char* own : {"world", "origin", "com"}) world_.names.take(own);
    for (XmlElement& child : XmlChildren(root)) {
      if (urdf::is(child, "worldbody")) take_names(child);
    }
    add_link("world", name_spot(root), Eigen::Isometry3d::Identity());
    world_.bodies["world"] = 0;
    Content content;
    for (XmlElement& child : XmlChildren(root)) {
      if (!urdf::is(child, "worldbody")) continue;
      Element element(child, "the worldbody", messages_, false);
      sort_content(element, {&child, Eigen::Isometry3d::Identity(), {}}, content);
      for (const Part& joint : content.joints) refuse_joint(*joint.xml);
      content.joints.clear();
    }
    read_geoms(content, "the worldbody", false);
    if (robot().links.size() == 1 && content.bodies.empty()) {
      messages_.error(robot().spot, "bad-urdf", "the worldbody has no body");
    }
    add_sites(content.sites, 0);
    for (const Part& body : content.bodies) read_body(body, 0);
    if (touching_ > 1) messages_.ignore("contact between geoms");
    return std::move(world_);
  }

 private:
  urdf::Robot& robot() { return world_.robot; }

  /// Names that the file gives are not to be taken by what is made up here.
  void take_names(XmlElement& xml) {
    for (XmlElement& child : XmlChildren(xml)) {
      const char* name = child.Attribute("name");
      const bool counts = urdf::is(child, "body") || urdf::is(child, "joint") || urdf::is(child, "freejoint");
      if (name != nullptr && counts) world_.names.take(name);
      if (name != nullptr && urdf::is(child, "joint")) joint_names_.take(name);
      take_names(child);
    }
  }

  int add_link(const std::string& name, const Spot& spot, const Eigen::Isometry3d& pose) {
    urdf::Link link;
    link.name = name;
    link.spot = link.element = link.mass_spot = link.inertia_spot = spot;
    robot().links.push_back(std::move(link));
    world_.poses.push_back(pose);
    return static_cast<int>(robot().links.size()) - 1;
  }

  // --- content ---------------------------------------------------------------------------------------------------

  void sort_content(Element& element, const Part& owner, Content& content) {
    for (XmlElement& child : XmlChildren(*owner.xml)) {
      const Part part{&child, owner.frame, owner.standard_class};
      if (urdf::is(child, "joint") || urdf::is(child, "freejoint")) content.joints.push_back(part);
      if (urdf::is(child, "geom")) content.geoms.push_back(part);
      if (urdf::is(child, "site")) content.sites.push_back(part);
      if (urdf::is(child, "body")) content.bodies.push_back(part);
      if (urdf::is(child, "frame")) read_frame(part, content);
    }
    for (const XmlElement& child : XmlChildren(*owner.xml)) refuse_unexpanded(child, messages_);
    for (const char* name : {"joint", "freejoint", "geom", "site", "body", "frame", "camera", "light", "include",
                             "replicate", "composite", "flexcomp", "attach"}) {
      element.know(name);
    }
    if (urdf::is(*owner.xml, "body")) content.inertial = element.child("inertial");
    element.finish();
  }

  void read_frame(const Part& part, Content& content) {
    Element element(*part.xml, "a frame", messages_, false);
    const Eigen::Isometry3d pose = read_pose(element, settings_, messages_);
    element.find("name");
    sort_content(element, {part.xml, part.frame * pose, class_in(element, part)}, content);
  }

  std::string class_in(Element& element, const Part& part) {
    const XmlAttribute* own = element.find("childclass");
    defaults_.require(*part.xml, "childclass");
    return own == nullptr ? part.standard_class : own->Value();
  }

  void refuse_joint(const XmlElement& xml) {
    messages_.error(name_spot(xml), "bad-urdf", "the worldbody stands still: it has no joints");
  }

  // --- bodies ----------------------------------------------------------------------------------------------------

  void read_body(const Part& part, int parent) {
    XmlElement& xml = *part.xml;
    const char* name = xml.Attribute("name");
    const std::string owner = name == nullptr ? "a body" : fmt::format("body '{}'", name);
    Element element(xml, owner, messages_, false);
    element.find("name");
    const Eigen::Isometry3d pose = part.frame * read_pose(element, settings_, messages_);
    note_special(element);
    Content content;
    sort_content(element, {&xml, Eigen::Isometry3d::Identity(), class_in(element, part)}, content);

    const int link = add_link(name == nullptr ? world_.names.fresh("body") : name, spot_of(xml, "name"),
                              world_.poses[at(parent)] * pose);
    require_fresh(name, link);
    read_mass(content, link, owner);
    std::vector<OwnJoint> own;
    for (const Part& joint : content.joints) own.push_back(own_joint(joint));
    rename_frame(link, own.empty());
    const Hanging hanging{link, parent, pose, robot().links[at(link)].name, robot().links[at(link)].spot};
    robot().joints.push_back(joint_of_body(std::move(own), hanging, world_.names, messages_));
    add_sites(content.sites, link);
    for (const Part& child : content.bodies) read_body(child, link);
  }

  void require_fresh(const char* name, int link) {
    if (name == nullptr) return;
    const auto [known, fresh] = world_.bodies.emplace(name, link);
    if (fresh) return;
    robot().ambiguous = true;
    messages_.error(robot().links[at(link)].spot, "bad-urdf",
                    fmt::format("the body '{}' exists already: first on line {}", name,
                                robot().links[at(known->second)].spot.line));
  }

  void note_special(Element& element) {
    const XmlElement& xml = element.xml();
    for (const char* name : {"user", "sleep"}) element.find(name);
    if (choice(element, "mocap", {"false", "true"}, 0, messages_) == 1) {
      messages_.warning(spot_of(xml, "mocap"), "urdf-ignored",
                        fmt::format("{}, moved from outside in MuJoCo, stands still here", element.owner()));
    }
    if (element.number("gravcomp", 0.0) == 0.0) return;
    messages_.warning(spot_of(xml, "gravcomp"), "urdf-ignored",
                      fmt::format("the gravcomp of {} is not used: it feels its whole weight", element.owner()));
  }

  /// A body without mass on its parent is a mere frame, whose name frames of joints may have.
  void rename_frame(int index, bool fixed) {
    urdf::Link& link = robot().links[at(index)];
    if (!fixed || link.has_mass() || !joint_names_.has(link.name)) return;
    const std::string given = world_.names.fresh(link.name + "-frame");
    messages_.warning(link.spot, "urdf-renamed",
                      fmt::format("the body '{}', a mere frame, is called '{}' here", link.name, given));
    link.name = given;
  }

  void read_mass(const Content& content, int index, const std::string& owner) {
    using Inertia = Settings::Inertia;
    const bool by_geoms = settings_.inertia_from_geoms == Inertia::always ||
                          (settings_.inertia_from_geoms == Inertia::where_missing && content.inertial == nullptr);
    const std::vector<MassProperties> geoms = read_geoms(content, owner, by_geoms);
    urdf::Link& link = robot().links[at(index)];
    if (content.inertial != nullptr) read_inertial(*content.inertial, owner, settings_, link, messages_);
    if (by_geoms) take_geoms(geoms, link);
    bound_inertia(settings_, link);
  }

  std::vector<MassProperties> read_geoms(const Content& content, const std::string& owner, bool counts) {
    std::vector<MassProperties> masses;
    for (const Part& part : content.geoms) {
      defaults_.complete(*part.xml, "geom", part.standard_class);
      if (can_touch(*part.xml)) ++touching_;
      auto mass = read_geom(*part.xml, owner, counts, settings_, messages_);
      if (!mass) continue;
      mass->com = part.frame * mass->com;
      mass->inertia = part.frame.linear() * mass->inertia * part.frame.linear().transpose();
      masses.push_back(*mass);
    }
    return masses;
  }

  OwnJoint own_joint(const Part& part) {
    if (urdf::is(*part.xml, "joint")) defaults_.complete(*part.xml, "joint", part.standard_class);
    OwnJoint own = read_joint(*part.xml, part.frame, settings_, messages_);
    if (own.joint.name.empty()) return own;
    const auto [known, fresh] = joint_lines_.emplace(own.joint.name, own.joint.spot.line);
    if (!fresh) {
      robot().ambiguous = true;
      messages_.error(own.joint.spot, "bad-urdf",
                      fmt::format("the joint '{}' exists already: first on line {}", own.joint.name, known->second));
    }
    return own;
  }

  // --- sites -----------------------------------------------------------------------------------------------------

  /// A site is a frame of its body, so a link without mass.
  void add_sites(const std::vector<Part>& sites, int link) {
    for (const Part& part : sites) {
      XmlElement& xml = *part.xml;
      defaults_.complete(xml, "site", part.standard_class);
      const char* name = xml.Attribute("name");
      Element element(xml, name == nullptr ? "a site" : fmt::format("site '{}'", name), messages_, false);
      for (const char* known : {"name", "class", "type", "size", "group", "material", "rgba", "user"}) {
        element.find(known);
      }
      Eigen::Isometry3d pose = read_pose(element, settings_, messages_);
      const std::vector<double> ends = element.numbers("fromto", 6);
      if (!ends.empty()) {
        const Eigen::Vector3d from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
        pose.translation() = 0.5 * (from + to);
        if ((from - to).norm() > 0.0) pose.linear() = turn_to(from - to);
      }
      element.finish();
      if (name != nullptr) add_site(name, part.frame * pose, link, spot_of(xml, "name"));
    }
  }

  void add_site(const std::string& name, const Eigen::Isometry3d& pose, int link, const Spot& spot) {
    if (!world_.sites.emplace(name, Site{link, pose}).second) {
      messages_.error(spot, "bad-urdf", fmt::format("the site '{}' exists already", name));
    }
    const std::string given = world_.names.fresh(name);
    if (given != name) {
      messages_.warning(spot, "urdf-renamed", fmt::format("the site '{}' is called '{}' here", name, given));
    }
    const int index = add_link(given, spot, world_.poses[at(link)] * pose);
    robot().joints.push_back(joint_of_body({}, {index, link, pose, given, spot}, world_.names, messages_));
  }

  const Settings& settings_;
  const Defaults& defaults_;
  Messages& messages_;
  World world_;
  NamePool joint_names_;
  std::map<std::string, int> joint_lines_;
  int touching_ = 0;
};

}  // namespace

World read_world(XmlElement& root, const Settings& settings, const Defaults& defaults, Messages& messages) {
  return WorldReader(settings, defaults, messages).read(root);
}

bool refuse_unexpanded(const XmlElement& xml, Messages& messages) {
  for (const char* word : {"include", "replicate", "composite", "flexcomp", "attach"}) {
    if (!urdf::is(xml, word)) continue;
    const char* file = xml.Attribute("file");
    messages.error(name_spot(xml), "bad-urdf",
                   file == nullptr ? fmt::format("'{}' is not expanded", word)
                                   : fmt::format("'{}' of the file '{}' is not read", word, file),
                   {}, "have MuJoCo save the model (mj_saveLastXML), which writes all of it into one file");
    return true;
  }
  return false;
}

}  // namespace freeplay::mjcf
