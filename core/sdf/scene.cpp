#include "sdf/scene.h"

#include <algorithm>

#include <fmt/format.h>

#include "urdf/text_value.h"

namespace freeplay::sdf {
namespace {

class SceneReader {
 public:
  SceneReader(Scene& scene, Messages& messages) : scene_(scene), messages_(messages) {}

  void read(XmlElement& root) {
    scene_.spot = scene_.gravity_spot = name_spot(root);
    Element element(root, "the file", messages_, false);
    read_version(element);
    XmlElement* world = element.child("world");
    if (world != nullptr && root.FirstChildElement("model") != nullptr) {
      messages_.error(name_spot(*world), "bad-urdf", "the file holds a world and models beside it", {},
                      "keep one of the two");
      return element.finish();
    }
    if (world != nullptr) {
      read_world(*world);
    } else {
      read_models(element, root, Frames::world, false);
    }
    for (const char* other : {"actor", "light"}) element.pass_over(other);
    element.finish();
    if (scene_.links.empty()) messages_.error(scene_.spot, "bad-urdf", "the file has no link");
  }

 private:
  void read_version(Element& element) {
    const XmlAttribute* version = element.require("version");
    if (version == nullptr) return;
    const std::string text = version->Value();
    for (int minor = 2; minor <= 12; ++minor) {
      if (text != fmt::format("1.{}", minor)) continue;
      scene_.minor = minor;
      return;
    }
    messages_.error(urdf::spot_of(element.xml(), *version), "bad-urdf",
                    fmt::format("the version '{}' of SDFormat is not read", printable_of(text)), {},
                    "versions 1.2 to 1.12");
  }

  static std::string printable_of(const std::string& text) { return text.substr(0, 16); }

  // --- worlds ------------------------------------------------------------------------------------------------------

  void read_world(XmlElement& xml) {
    Element world(xml, "the world", messages_, false);
    world.find("name");
    read_models(world, xml, Frames::world, false);
    XmlElement* carrier = nullptr;
    XmlElement* physics = xml.FirstChildElement("physics");
    if (XmlElement* own = world.child("gravity")) {
      carrier = own;
    } else if (physics != nullptr && scene_.minor < 6) {  // up to 1.5 gravity stood there
      carrier = physics->FirstChildElement("gravity");
    }
    if (carrier != nullptr) {
      const std::vector<double> gravity = urdf::text_numbers(*carrier, 3, messages_);
      if (!gravity.empty()) scene_.gravity = {gravity[0], gravity[1], gravity[2]};
      scene_.gravity_spot = urdf::whole_text_spot(*carrier);
    }
    if (XmlElement* state = world.child("state")) {
      messages_.warning(name_spot(*state), "urdf-ignored",
                        "the stored state of the world is not used: the motion begins where its models are drawn");
    }
    for (const char* other : {"physics", "scene", "light", "magnetic_field", "wind", "gui", "road", "population",
                              "audio", "spherical_coordinates", "atmosphere", "actor"}) {
      world.pass_over(other);
    }
    world.finish();
  }

  // --- models ------------------------------------------------------------------------------------------------------

  /// Models, links, joints and frames that stand in a world, a model or the file itself.
  void read_models(Element& owner, XmlElement& xml, int scope, bool is_static) {
    for (XmlElement& child : XmlChildren(xml)) {
      if (urdf::is(child, "include")) {
        refuse_include(child);
      } else if (urdf::is(child, "model")) {
        read_model(child, scope, is_static);
      } else if (urdf::is(child, "frame")) {
        read_frame(child, scope);
      } else if (urdf::is(child, "joint")) {
        read_joint(child, scope, scene_, messages_);
      } else if (urdf::is(child, "plugin")) {
        const char* name = child.Attribute("name");
        messages_.ignore("plugin", name == nullptr ? "" : name);
      }
    }
    for (const char* known : {"include", "model", "frame", "joint", "plugin"}) owner.know(known);
  }

  void refuse_include(XmlElement& xml) {
    const XmlElement* uri = xml.FirstChildElement("uri");
    const std::string from = uri == nullptr ? "" : urdf::trimmed_text(*uri);
    messages_.error(name_spot(xml), "bad-urdf",
                    from.empty() ? "'include' is not read" : fmt::format("'include' of '{}' is not read", from), {},
                    "write the model into this file: 'gz sdf -p' prints it with what it includes");
  }

  void read_model(XmlElement& xml, int scope, bool is_static) {
    const char* written = xml.Attribute("name");
    Element model(xml, written == nullptr ? "a model" : fmt::format("model '{}'", written), messages_, false);
    Frame frame;
    frame.kind = Frame::Kind::model;
    frame.scope = scope;
    const Frame::Name name = read_name(model, messages_);
    frame.name = name.text;
    frame.spot = name.spot;
    read_pose(model, frame, true, scene_, messages_);
    frame.attached_to = attribute(model, "canonical_link");
    frame.placement = attribute(model, "placement_frame");
    const bool own_static = read_flag(model, "static", false, messages_);
    frame.is_static = is_static || own_static;
    const bool stands = frame.is_static;
    const int index = scene_.frames.add(std::move(frame), scene_.names_frames());
    for (XmlElement& child : XmlChildren(xml)) {
      if (urdf::is(child, "link")) read_link(child, index, stands, scene_, messages_);
    }
    model.know("link");
    read_models(model, xml, index, stands);
    for (const char* other : {"self_collide", "allow_auto_disable", "enable_wind"}) {
      read_flag(model, other, false, messages_);
    }
    model.pass_over("gripper");
    model.finish();
  }

  Frame::Name attribute(Element& element, const char* key) {
    const XmlAttribute* found = element.find(key);
    if (found == nullptr) return {};
    return {found->Value(), urdf::spot_of(element.xml(), *found)};
  }

  void read_frame(XmlElement& xml, int scope) {
    const char* written = xml.Attribute("name");
    Element element(xml, written == nullptr ? "a frame" : fmt::format("frame '{}'", written), messages_, false);
    Frame frame;
    frame.scope = scope;
    const Frame::Name name = read_name(element, messages_);
    frame.name = name.text;
    frame.spot = name.spot;
    frame.attached_to = attribute(element, "attached_to");
    read_pose(element, frame, true, scene_, messages_);
    element.finish();
    scene_.frames.add(std::move(frame), scene_.names_frames());
  }

  static Spot name_spot(const XmlElement& xml) { return urdf::name_spot(xml); }

  Scene& scene_;
  Messages& messages_;
};

}  // namespace

void read_scene(XmlElement& root, Scene& scene, Messages& messages) { SceneReader(scene, messages).read(root); }

}  // namespace freeplay::sdf
