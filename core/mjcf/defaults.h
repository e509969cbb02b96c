// MjcfDefaults: the classes of an MJCF file, whose attributes its elements inherit.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "urdf/element.h"

namespace freeplay::mjcf {

class Defaults {
 public:
  Defaults(XmlElement& root, urdf::Messages& messages);

  /// Writes into the element what its class, else `class_of_body`, else the main class says of elements of `kind` and
  /// the element itself does not.
  void complete(XmlElement& element, const std::string& kind, const std::string& class_of_body) const;

  /// Reports the class that an attribute names, if there is none.
  void require(const XmlElement& element, const char* attribute) const;

 private:
  using Attributes = std::vector<std::pair<std::string, std::string>>;
  using Class = std::map<std::string, Attributes>;  ///< by the name of elements

  void read(XmlElement& xml, const Class& inherited, const std::string& standard_name);

  urdf::Messages& messages_;
  std::map<std::string, Class> classes_;
  std::vector<std::string> names_;
  std::string main_ = "main";
};

}  // namespace freeplay::mjcf
