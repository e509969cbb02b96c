// XmlFault: why a text is not well-formed XML, in words.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace freeplay {

struct XmlFault {
  std::size_t position = 0;  ///< of the byte to show
  std::string message, hint;
  bool too_large = false;
};

inline constexpr std::size_t most_xml_attributes = 64;

struct OpenXmlElement {
  std::string name;
  std::size_t content;  ///< where its start tag ends
};

/// How far a strict parser came.
struct XmlStop {
  std::size_t token = 0;             ///< where the markup or text begins that it refuses
  std::size_t byte = 0;              ///< the byte there that it did not expect
  std::vector<OpenXmlElement> open;  ///< the elements that are open there
  bool has_root = false;             ///< a root element was opened
  std::string reason;                ///< of the parser itself
};

/// The first byte that is no UTF-8 text, or character that XML does not allow.
std::optional<XmlFault> fault_of_characters(std::string_view text);

/// Says what is wrong where the parser stopped, as exactly as the bytes there allow.
XmlFault xml_fault(std::string_view text, const XmlStop& stop);

}  // namespace freeplay
