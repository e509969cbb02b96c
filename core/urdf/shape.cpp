#include "urdf/shape.h"

#include <fmt/format.h>

namespace freeplay::urdf {
namespace {

class ShapeChecker {
 public:
  explicit ShapeChecker(Messages& messages) : messages_(messages) {}

  void check(XmlElement& xml, const std::string& owner) {
    Element shape(xml, fmt::format("a {} of {}", xml.Name(), owner), messages_, false);
    shape.find("name");
    if (XmlElement* origin = shape.child("origin")) check_origin(*origin, shape.owner());
    if (XmlElement* geometry = shape.required_child("geometry")) check_geometry(*geometry, shape.owner());
    if (XmlElement* material = shape.child("material")) check_material(*material, shape.owner(), false);
    shape.finish();
  }

  /// A material of a shape may be a mere name, one of the robot says what it looks like.
  void check_material(XmlElement& xml, const std::string& owner, bool of_robot) {
    Element material = part(xml, owner);
    material.require("name");
    XmlElement* texture = material.child("texture");
    if (texture != nullptr) {
      Element element = part(*texture, material.owner());
      element.require("filename");
      element.finish();
    }
    if (XmlElement* color = material.child("color")) {
      check_color(*color, of_robot ? material.owner() : owner);
    } else if (of_robot && texture == nullptr) {
      material.required_child("color");
    }
    material.finish();
  }

 private:
  Element part(XmlElement& xml, const std::string& owner) {
    return {xml, fmt::format("the {} of {}", xml.Name(), owner), messages_, false};
  }

  void check_origin(XmlElement& xml, const std::string& owner) {
    Element origin = part(xml, owner);
    for (const char* key : {"xyz", "rpy"}) origin.numbers(key, 3);
    origin.finish();
  }

  void check_geometry(XmlElement& xml, const std::string& owner) {
    Element geometry = part(xml, owner);
    if (XmlElement* box = geometry.child("box")) {
      Element element = part(*box, owner);
      if (element.require("size") != nullptr) element.numbers("size", 3);
      element.finish();
    }
    if (XmlElement* sphere = geometry.child("sphere")) {
      Element element = part(*sphere, owner);
      element.required_number("radius");
      element.finish();
    }
    for (const char* round : {"cylinder", "capsule"}) {
      XmlElement* child = geometry.child(round);
      if (child == nullptr) continue;
      Element element = part(*child, owner);
      for (const char* key : {"radius", "length"}) element.required_number(key);
      element.finish();
    }
    if (XmlElement* mesh = geometry.child("mesh")) {
      Element element = part(*mesh, owner);
      element.require("filename");
      element.numbers("scale", 3);
      element.finish();
    }
    if (xml.FirstChildElement() == nullptr) {
      messages_.error(geometry.name_spot(), "bad-urdf", fmt::format("{} names no shape", geometry.owner()), {},
                      "shapes: box, sphere, cylinder, mesh");
    }
    geometry.finish();
  }

  void check_color(XmlElement& xml, const std::string& owner) {
    Element color = part(xml, owner);
    if (color.require("rgba") != nullptr) {
      for (const double part : color.numbers("rgba", 4)) {
        if (part >= 0.0 && part <= 1.0) continue;
        messages_.error(spot_of(xml, "rgba"), "bad-urdf",
                        fmt::format("'rgba' of {} must be from 0 to 1, not {}", color.owner(), part));
        break;
      }
    }
    color.finish();
  }

  Messages& messages_;
};

}  // namespace

void check_shape(XmlElement& xml, const std::string& owner, Messages& messages) {
  ShapeChecker(messages).check(xml, owner);
}

void check_material(XmlElement& xml, Messages& messages) {
  ShapeChecker(messages).check_material(xml, "the robot", true);
}

}  // namespace freeplay::urdf
