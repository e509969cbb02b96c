// XmlDocument: an XML file as a tinyxml2 document whose elements know their places.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

#include "base/diagnostics.h"
#include "base/text_place.h"

namespace freeplay {

using XmlElement = tinyxml2::XMLElement;
using XmlAttribute = tinyxml2::XMLAttribute;

/// Where an element stands in the text; tinyxml2 counts lines alone.
struct XmlPlaces {
  TextPlace begin, name;  ///< of the '<' and of the word that follows it
  TextPlace text{0, 0};   ///< of the first character of its own text that is no blank; 0:0 where there is none
  std::vector<TextPlace> attributes;
};

class XmlDocument {
 public:
  XmlElement& root() { return *document_.RootElement(); }

 private:
  friend std::unique_ptr<XmlDocument> parse_xml(std::string_view, const std::string&, const char*, Diagnostics&);

  tinyxml2::XMLDocument document_;
  std::vector<XmlPlaces> places_;  ///< of the elements, in the order of their start tags
};

/// Of an element of an XmlDocument; 1:1 for one that was added later.
const XmlPlaces& places_of(const XmlElement& element);
/// Of the name of an attribute; null for one that was added later.
const TextPlace* place_of(const XmlElement& element, const XmlAttribute& attribute);

/// The text between the children of an element, one piece after the other; "" where all of it is blank.
std::string text_of(const XmlElement& element);

/// The child elements, for a range-based loop.
class XmlChildren {
 public:
  class Iterator {
   public:
    explicit Iterator(XmlElement* at) : at_(at) {}
    XmlElement& operator*() const { return *at_; }
    Iterator& operator++() {
      at_ = at_->NextSiblingElement();
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    XmlElement* at_;
  };

  explicit XmlChildren(XmlElement& parent) : parent_(parent) {}
  Iterator begin() const { return Iterator(parent_.FirstChildElement()); }
  static Iterator end() { return Iterator(nullptr); }

 private:
  XmlElement& parent_;
};

/// Reads `text` into a document, or returns null after a message. What is not well-formed XML 1.0 in UTF-8 is reported
/// as `id`, and so is a document type, since its entities can explode; more than 64 levels, 64 attributes of an
/// element, or 1 000 000 elements and attributes are `too-large`. `diagnostics` is to know the text already. Linear in
/// time and memory.
///
/// Expat goes first: tinyxml2 takes much that is not well-formed (a second root, unknown entities, control characters,
/// other encodings) and knows no columns.
std::unique_ptr<XmlDocument> parse_xml(std::string_view text, const std::string& file_name, const char* id,
                                       Diagnostics& diagnostics);

}  // namespace freeplay
