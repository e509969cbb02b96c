#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "sdf/scene.h"
#include "urdf/text_value.h"

namespace freeplay::sdf {
namespace {

XmlElement* value_child(Element& element, const char* name, Messages& messages) {
  XmlElement* xml = element.child(name);
  if (xml == nullptr) return nullptr;
  Element value(*xml, fmt::format("the {} of {}", name, element.owner()), messages, false);
  value.finish(true);
  return xml;
}

/// SDFormat writes limits that are none as infinite.
std::optional<double> infinite(std::string_view text) {
  const double sign = text.starts_with('-') ? -1.0 : 1.0;
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const bool is_word = text == "inf" || text == "Inf" || text == "INF" || text == "infinity";
  return is_word ? std::optional(sign * infinity) : std::nullopt;
}

}  // namespace

double read_value(Element& element, const char* name, double standard, Messages& messages, Spot* spot) {
  XmlElement* xml = value_child(element, name, messages);
  if (xml == nullptr) return standard;
  if (spot != nullptr) *spot = urdf::whole_text_spot(*xml);
  if (const auto whole = infinite(urdf::trimmed_text(*xml)); whole && std::isinf(standard)) return *whole;
  const std::vector<double> read = urdf::text_numbers(*xml, 1, messages);
  return read.empty() ? standard : read[0];
}

bool read_flag(Element& element, const char* name, bool standard, Messages& messages) {
  XmlElement* xml = value_child(element, name, messages);
  if (xml == nullptr) return standard;
  const std::string word = urdf::trimmed_text(*xml);
  if (word == "true" || word == "1") return true;
  if (word == "false" || word == "0") return false;
  messages.error(urdf::whole_text_spot(*xml), "bad-urdf",
                 fmt::format("the {} of {} must be true or false, not '{}'", name, element.owner(), word));
  return standard;
}

Frame::Name read_word(Element& element, const char* name, bool required, Messages& messages) {
  XmlElement* xml = value_child(element, name, messages);
  if (xml == nullptr && required) element.required_child(name);
  if (xml == nullptr) return {{}, element.name_spot()};
  Frame::Name word{urdf::trimmed_text(*xml), urdf::whole_text_spot(*xml)};
  if (required && word.text.empty()) {
    messages.error(word.spot, "bad-urdf", fmt::format("the {} of {} is empty", name, element.owner()));
  }
  return word;
}

Frame::Name read_name(Element& element, Messages& messages) {
  const XmlAttribute* name = element.require("name");
  if (name == nullptr) return {{}, element.name_spot()};
  const std::string text = name->Value();
  const Spot spot = urdf::spot_of(element.xml(), *name);
  const bool reserved = text == "world" || (text.size() > 3 && text.starts_with("__") && text.ends_with("__"));
  if (text.empty() || reserved) {
    messages.error(spot, "bad-urdf",
                   text.empty() ? fmt::format("the name of a {} is empty", element.xml().Name())
                                : fmt::format("the name '{}' is one of SDFormat's own", text));
  }
  return {text, spot};
}

void read_pose(Element& element, Frame& frame, bool names, const Scene& scene, Messages& messages) {
  XmlElement* xml = element.child("pose");
  if (xml == nullptr) return;
  Element pose(*xml, "the pose of " + element.owner(), messages, false);
  for (const char* known : {"degrees", "rotation_format"}) pose.find(known);
  frame.pose = urdf::text_pose(*xml, messages);
  for (const char* key : {"relative_to", "frame"}) {
    const bool own = scene.names_frames() == (std::string_view(key) == "relative_to");
    const XmlAttribute* other = own || xml->FindAttribute(key) != nullptr ? pose.find(key) : nullptr;
    if (other == nullptr || std::string_view(other->Value()).empty()) continue;
    if (own && names && scene.names_frames()) {
      frame.relative_to = {other->Value(), urdf::spot_of(*xml, *other)};
      continue;
    }
    messages.error(urdf::spot_of(*xml, *other), "bad-urdf",
                   names ? fmt::format("'{}' of {} is not read in version 1.{}", key, pose.owner(), scene.minor)
                         : fmt::format("{} is relative to what it stands in; it names no frame", pose.owner()),
                   {}, names ? "poses name frames by 'relative_to', from version 1.7 on" : "");
  }
  pose.finish(true);
}

}  // namespace freeplay::sdf
