#include <fmt/format.h>

#include "sdf/scene.h"

namespace freeplay::sdf {
namespace {

class LinkReader {
 public:
  LinkReader(XmlElement& xml, Scene& scene, Messages& messages)
      : xml_(xml), scene_(scene), messages_(messages), element_(xml, owner_of(xml), messages, false) {}

  void read(int scope, bool is_static) {
    Frame frame;
    frame.kind = Frame::Kind::link;
    frame.scope = scope;
    const Frame::Name name = read_name(element_, messages_);
    frame.name = name.text;
    frame.spot = name.spot;
    read_pose(element_, frame, true, scene_, messages_);
    urdf::Link& link = out_.link;
    link.spot = link.mass_spot = link.inertia_spot = name.spot;
    link.element = element_.begin_spot();
    link.moments = {name.spot, name.spot, name.spot};
    link.has_inertial = true;
    link.mass = 1.0;
    link.inertia.setIdentity();
    read_inertial(is_static);
    note_special(is_static);
    if (xml_.FirstChildElement("collision") != nullptr) ++scene_.touching;
    for (const char* other : {"collision", "visual", "sensor", "projector", "audio_sink", "audio_source", "battery",
                              "light", "particle_emitter"}) {
      element_.pass_over(other);
    }
    element_.finish();
    if (is_static) {
      link.has_inertial = false;
      link.mass = 0.0;
      link.inertia.setZero();
    }
    out_.is_static = is_static;
    out_.frame = scene_.frames.add(std::move(frame), scene_.names_frames());
    scene_.links.push_back(std::move(out_));
  }

 private:
  static std::string owner_of(const XmlElement& xml) {
    const char* name = xml.Attribute("name");
    return name == nullptr ? "a link" : fmt::format("link '{}'", name);
  }

  void read_inertial(bool is_static) {
    XmlElement* xml = element_.child("inertial");
    bool has_mass = false, has_inertia = false;
    const int errors = messages_.errors();
    if (xml != nullptr) {
      has_mass = xml->FirstChildElement("mass") != nullptr;
      has_inertia = xml->FirstChildElement("inertia") != nullptr;
      read_inertial_values(*xml);
    }
    out_.link.inertia_known = messages_.errors() == errors;
    if (is_static || (has_mass && has_inertia)) return;
    messages_.warning(xml == nullptr ? element_.begin_spot() : urdf::begin_spot(*xml), "missing-key",
                      fmt::format("{} says no {}; SDFormat takes {}", element_.owner(),
                                  has_mass      ? "inertia"
                                  : has_inertia ? "mass"
                                                : "mass and inertia",
                                  has_mass      ? "1 kg m^2 about each axis"
                                  : has_inertia ? "1 kg"
                                                : "1 kg and 1 kg m^2 about each axis"));
  }

  void read_inertial_values(XmlElement& xml) {
    urdf::Link& link = out_.link;
    Element inertial(xml, "the inertial of " + element_.owner(), messages_, false);
    const XmlAttribute* by_shape = inertial.find("auto");
    if (by_shape != nullptr && (by_shape->IntValue() != 0 || by_shape->BoolValue())) {
      messages_.error(urdf::spot_of(xml, *by_shape), "bad-urdf",
                      fmt::format("{} is to follow from shapes, which is not computed here", inertial.owner()), {},
                      "write mass and inertia out");
    }
    Frame frame;
    read_pose(inertial, frame, false, scene_, messages_);
    link.inertial = frame.pose;
    link.mass = read_value(inertial, "mass", 1.0, messages_, &link.mass_spot);
    if (link.mass < 0.0) {
      messages_.error(link.mass_spot, "bad-urdf",
                      fmt::format("the mass of {} must be positive, not {} kg", element_.owner(), link.mass));
    }
    if (XmlElement* inertia = inertial.child("inertia")) read_inertia(*inertia);
    for (const char* other : {"density", "auto_inertia_params"}) inertial.pass_over(other);
    if (XmlElement* water = inertial.child("fluid_added_mass")) {
      messages_.warning(urdf::name_spot(*water), "urdf-ignored",
                        fmt::format("the fluid_added_mass of {} is not used", element_.owner()));
    }
    inertial.finish();
  }

  void read_inertia(XmlElement& xml) {
    urdf::Link& link = out_.link;
    Element inertia(xml, "the inertia of " + element_.owner(), messages_, true);
    link.inertia_spot = urdf::name_spot(xml);
    link.moments = {link.inertia_spot, link.inertia_spot, link.inertia_spot};
    const double xx = read_value(inertia, "ixx", 1.0, messages_, link.moments.data());
    const double yy = read_value(inertia, "iyy", 1.0, messages_, &link.moments[1]);
    const double zz = read_value(inertia, "izz", 1.0, messages_, &link.moments[2]);
    const double xy = read_value(inertia, "ixy", 0.0, messages_), xz = read_value(inertia, "ixz", 0.0, messages_),
                 yz = read_value(inertia, "iyz", 0.0, messages_);
    link.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    inertia.finish();
  }

  void warn(const char* child, const char* what) {
    messages_.warning(urdf::name_spot(*xml_.FirstChildElement(child)), "urdf-ignored",
                      fmt::format("the {} of {} {}", child, element_.owner(), what));
  }

  /// What would change the motion of this link and is not modelled.
  void note_special(bool is_static) {
    const bool heavy = read_flag(element_, "gravity", true, messages_);
    const bool moved = read_flag(element_, "kinematic", false, messages_);
    if (!heavy && !is_static) warn("gravity", "is not switched off: it feels its whole weight");
    if (moved && !is_static) warn("kinematic", "is not used: forces move it");
    if (XmlElement* decay = element_.child("velocity_decay")) {
      Element values(*decay, "the velocity_decay of " + element_.owner(), messages_, false);
      const double linear = read_value(values, "linear", 0.0, messages_);
      const double angular = read_value(values, "angular", 0.0, messages_);
      values.finish();
      if (linear != 0.0 || angular != 0.0) warn("velocity_decay", "is not used");
    }
    // These say nothing about a motion without contact and wind.
    for (const char* other : {"self_collide", "enable_wind", "must_be_base_link"}) {
      read_flag(element_, other, false, messages_);
    }
  }

  XmlElement& xml_;
  Scene& scene_;
  Messages& messages_;
  Element element_;
  SceneLink out_;
};

}  // namespace

void read_link(XmlElement& xml, int scope, bool is_static, Scene& scene, Messages& messages) {
  LinkReader(xml, scene, messages).read(scope, is_static);
}

}  // namespace freeplay::sdf
