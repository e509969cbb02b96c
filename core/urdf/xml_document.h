// XmlDocument: reads XML into elements that know their places.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/text_place.h"

namespace freeplay {

struct XmlAttribute {
  std::string name, value;  ///< value: references resolved, line feeds as they are
  TextPlace place;          ///< of the name
};

struct XmlElement {
  std::string name;
  TextPlace place, name_place;  ///< of the '<' and of the word behind it
  std::vector<XmlAttribute> attributes;
  std::vector<XmlElement> children;
  std::string text;      ///< the characters between the children, one after the other
  TextPlace text_place;  ///< of the first of them that is no blank

  const XmlAttribute* attribute(std::string_view name) const;
  /// The first child of that name, or null.
  const XmlElement* child(std::string_view name) const;
};

/// Reads `text` and returns its root element. Stricter than most readers: what is not well-formed XML 1.0 in UTF-8 is
/// reported as `id`, and so is a document type, since its entities can explode; more than 64 levels, 64 attributes of
/// an element, or 1 000 000 elements and attributes are `too-large`. `diagnostics` is to know the text already. Linear
/// in time and memory.
///
/// Own code, since tinyxml2 knows no columns and takes what is not well-formed (an attribute twice, text after the
/// root, unknown entities).
std::optional<XmlElement> parse_xml(std::string_view text, const std::string& file_name, const char* id,
                                    Diagnostics& diagnostics);

}  // namespace freeplay
