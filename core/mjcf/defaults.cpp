#include "mjcf/defaults.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace freeplay::mjcf {
namespace {

void set(std::vector<std::pair<std::string, std::string>>& attributes, const std::string& name,
         const std::string& value) {
  const auto known = std::ranges::find_if(attributes, [&](const auto& one) { return one.first == name; });
  if (known == attributes.end()) {
    attributes.emplace_back(name, value);
  } else {
    known->second = value;
  }
}

}  // namespace

Defaults::Defaults(XmlElement& root, urdf::Messages& messages) : messages_(messages) {
  bool first = true;
  for (XmlElement& child : XmlChildren(root)) {
    if (!urdf::is(child, "default")) continue;
    if (const char* name = child.Attribute("class"); first && name != nullptr) main_ = name;
    first = false;
    read(child, classes_[main_], main_);
  }
  classes_[main_];
}

void Defaults::read(XmlElement& xml, const Class& inherited, const std::string& standard_name) {
  const char* name = xml.Attribute("class");
  if (name == nullptr && standard_name.empty()) {
    messages_.error(urdf::name_spot(xml), "bad-urdf", "a default inside of another needs the attribute 'class'");
    return;
  }
  const std::string own_name = name == nullptr ? standard_name : name;
  if (classes_.contains(own_name) && own_name != main_) {
    messages_.error(urdf::spot_of(xml, "class"), "bad-urdf", fmt::format("the class '{}' exists already", own_name));
  }
  names_.push_back(own_name);
  Class own = inherited;
  for (XmlElement& child : XmlChildren(xml)) {
    if (urdf::is(child, "default")) continue;
    for (const XmlAttribute* at = child.FirstAttribute(); at != nullptr; at = at->Next()) {
      set(own[child.Name()], at->Name(), at->Value());
    }
  }
  classes_[own_name] = own;
  for (XmlElement& child : XmlChildren(xml)) {
    if (urdf::is(child, "default")) read(child, own, {});
  }
}

void Defaults::complete(XmlElement& element, const std::string& kind, const std::string& class_of_body) const {
  require(element, "class");
  const char* own = element.Attribute("class");
  const auto found = classes_.find(own != nullptr ? own : class_of_body.empty() ? main_ : class_of_body);
  if (found == classes_.end()) return;
  const auto attributes = found->second.find(kind);
  if (attributes == found->second.end()) return;
  for (const auto& [name, value] : attributes->second) {
    if (element.FindAttribute(name.c_str()) == nullptr) element.SetAttribute(name.c_str(), value.c_str());
  }
}

void Defaults::require(const XmlElement& element, const char* attribute) const {
  const char* name = element.Attribute(attribute);
  if (name == nullptr || classes_.contains(name)) return;
  messages_.error(urdf::spot_of(element, attribute), "bad-urdf", fmt::format("unknown class '{}'", name),
                  messages_.suggest(name, names_));
}

}  // namespace freeplay::mjcf
