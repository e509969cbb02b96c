#include "io/urdf_shape.h"

#include <fmt/format.h>

namespace freeplay::urdf {
namespace {

class ShapeChecker {
 public:
  explicit ShapeChecker(Messages& messages) : messages_(messages) {}

  void check(const XmlElement& xml, const std::string& owner) {
    Element shape(xml, fmt::format("a {} of {}", xml.name, owner), messages_, false);
    shape.find("name");
    if (const XmlElement* origin = shape.child("origin")) check_origin(*origin, shape.owner());
    if (const XmlElement* geometry = shape.required_child("geometry")) check_geometry(*geometry, shape.owner());
    if (const XmlElement* material = shape.child("material")) check_material(*material, shape.owner());
    shape.finish();
  }

 private:
  Element part(const XmlElement& xml, const std::string& owner) {
    return {xml, fmt::format("the {} of {}", xml.name, owner), messages_, false};
  }

  void check_origin(const XmlElement& xml, const std::string& owner) {
    Element origin = part(xml, owner);
    for (const char* key : {"xyz", "rpy"}) origin.numbers(key, 3);
    origin.finish();
  }

  void check_geometry(const XmlElement& xml, const std::string& owner) {
    Element geometry = part(xml, owner);
    if (const XmlElement* box = geometry.child("box")) {
      Element element = part(*box, owner);
      if (element.require("size") != nullptr) element.numbers("size", 3);
      element.finish();
    }
    if (const XmlElement* sphere = geometry.child("sphere")) {
      Element element = part(*sphere, owner);
      element.required_number("radius");
      element.finish();
    }
    for (const char* round : {"cylinder", "capsule"}) {
      const XmlElement* child = geometry.child(round);
      if (child == nullptr) continue;
      Element element = part(*child, owner);
      for (const char* key : {"radius", "length"}) element.required_number(key);
      element.finish();
    }
    if (const XmlElement* mesh = geometry.child("mesh")) {
      Element element = part(*mesh, owner);
      element.require("filename");
      element.numbers("scale", 3);
      element.finish();
    }
    geometry.finish();
  }

  void check_material(const XmlElement& xml, const std::string& owner) {
    Element material = part(xml, owner);
    material.find("name");
    if (const XmlElement* color = material.child("color")) {
      Element element = part(*color, owner);
      element.numbers("rgba", 4);
      element.finish();
    }
    material.pass_over("texture");
    material.finish();
  }

  Messages& messages_;
};

}  // namespace

void check_shape(const XmlElement& xml, const std::string& owner, Messages& messages) {
  ShapeChecker(messages).check(xml, owner);
}

}  // namespace freeplay::urdf
