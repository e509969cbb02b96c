#include "urdf/xml_fault.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "base/text.h"
#include "urdf/blanks.h"

namespace freeplay {
namespace {

constexpr std::size_t none = std::string_view::npos;

bool is_name_character(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80 || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == ':' || c == '-' || c == '.';
}

bool begins_name(char c) { return is_name_character(c) && !(c >= '0' && c <= '9') && c != '-' && c != '.'; }

std::string_view name_at(std::string_view text, std::size_t begin) {
  std::size_t end = begin;
  if (end < text.size() && begins_name(text[end])) {
    while (end < text.size() && is_name_character(text[end])) ++end;
  }
  return text.substr(begin, end - begin);
}

std::size_t skip_blanks(std::string_view text, std::size_t from) {
  return std::min(text.find_first_not_of(blanks, from), text.size());
}

bool is_allowed(unsigned long code) {
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code == '\t' || code == '\n' || code == '\r' ||
         (code >= 0x20 && code <= 0x10FFFF && !surrogate && code != 0xFFFE && code != 0xFFFF);
}

/// Of what stands between '&' and ';'; "" where it stands for a character.
std::string fault_of_reference(std::string_view name) {
  for (const char* known : {"lt", "gt", "amp", "quot", "apos"}) {
    if (name == known) return {};
  }
  const std::string written = fmt::format("&{};", name.substr(0, 32));
  if (!name.starts_with('#')) return fmt::format("unknown entity '{}'", written);
  const bool hexadecimal = name.starts_with("#x");
  name.remove_prefix(hexadecimal ? 2 : 1);
  unsigned long code = 0;
  const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), code, hexadecimal ? 16 : 10);
  const bool whole = !name.empty() && error != std::errc::invalid_argument && stop == name.data() + name.size();
  if (!whole) return fmt::format("'{}' is not the number of a character", written);
  if (error == std::errc() && is_allowed(code)) return {};
  return fmt::format("'{}' stands for a character that XML does not allow", written);
}

std::optional<XmlFault> fault_of_references(std::string_view text, std::size_t begin, std::size_t end) {
  const std::string_view raw = text.substr(begin, end - begin);
  for (std::size_t sign = raw.find('&'); sign != none;) {
    const std::size_t close = raw.find(';', sign);
    if (close == none) return XmlFault{begin + sign, "'&' begins a reference; write '&amp;'", {}};
    const std::string why = fault_of_reference(raw.substr(sign + 1, close - sign - 1));
    if (!why.empty()) return XmlFault{begin + sign, why, {}};
    sign = raw.find('&', close);
  }
  return std::nullopt;
}

/// A start tag that was refused; `begin` is its '<'.
class StartTag {
 public:
  StartTag(std::string_view text, std::size_t begin) : text_(text), begin_(begin), at_(begin + 1) {}

  std::optional<XmlFault> fault() {
    element_ = name_at(text_, at_);
    if (element_.empty()) return XmlFault{begin_, "a name must follow '<'", "write '&lt;' in text"};
    at_ += element_.size();
    while (true) {
      const std::size_t last = at_;
      at_ = skip_blanks(text_, at_);
      if (at_ >= text_.size()) {
        return XmlFault{last, fmt::format("the tag of '{}' is not closed: '>' is missing", element_), {}};
      }
      if (text_[at_] == '>' || text_.substr(at_).starts_with("/>")) return std::nullopt;
      if (!begins_name(text_[at_])) {
        return XmlFault{at_, fmt::format("an attribute or '>' is expected in '{}'", element_), {}};
      }
      if (at_ == last) return XmlFault{at_, "a blank is missing between two attributes", {}};
      if (auto found = fault_of_attribute()) return found;
    }
  }

 private:
  std::optional<XmlFault> fault_of_attribute() {
    const std::size_t place = at_;
    const std::string_view name = name_at(text_, at_);
    at_ = skip_blanks(text_, at_ + name.size());
    if (at_ >= text_.size() || text_[at_] != '=') {
      return XmlFault{place, fmt::format("the attribute '{}' has no value", name), {}};
    }
    at_ = skip_blanks(text_, at_ + 1);
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '"' && quote != '\'') {
      return XmlFault{place, fmt::format("the value of '{}' must stand in quotes", name), {}};
    }
    const std::size_t begin = at_ + 1, end = text_.find(quote, begin);
    const std::size_t bracket = text_.substr(0, std::min(end, text_.size())).find('<', begin);
    // After the quote that closes a value the tag goes on; after one that opens the next value a value does.
    const char next = end != none && end + 1 < text_.size() ? text_[end + 1] : '>';
    const bool closes = end != none && (next == '/' || next == '>' || blanks.find(next) != none);
    if (end == none || (bracket != none && !closes)) {
      return XmlFault{place, fmt::format("the value of '{}' is not closed: {} is missing", name, quote), {}};
    }
    if (bracket != none) {
      return XmlFault{bracket, fmt::format("'<' cannot stand in the value of '{}'", name), "write '&lt;'"};
    }
    if (auto found = fault_of_references(text_, begin, end)) return found;
    at_ = end + 1;
    if (std::ranges::find(seen_, name) != seen_.end()) {
      return XmlFault{place, fmt::format("the attribute '{}' is given twice", name), {}};
    }
    if (seen_.size() == most_xml_attributes) return XmlFault{place, "more than 64 attributes in one element", {}, true};
    seen_.push_back(name);
    return std::nullopt;
  }

  std::string_view text_;
  std::size_t begin_, at_;
  std::string_view element_;
  std::vector<std::string_view> seen_;
};

XmlFault unclosed(const OpenXmlElement& element) {
  return {element.content, fmt::format("the element '{}' is opened here and never closed", element.name), {}};
}

XmlFault fault_of_end_tag(std::string_view text, const XmlStop& stop) {
  const std::string_view name = name_at(text, stop.token + 2);
  const std::size_t close = skip_blanks(text, stop.token + 2 + name.size());
  if (close >= text.size() || text[close] != '>') {
    return {stop.token,
            fmt::format("an end tag holds nothing but its name: </{}>", name.empty() ? std::string_view("name") : name),
            {}};
  }
  if (std::ranges::find(stop.open, name, &OpenXmlElement::name) != stop.open.end()) return unclosed(stop.open.back());
  return {stop.token, fmt::format("the end tag </{}> closes nothing", name), {}};
}

XmlFault fault_of_text(std::string_view text, const XmlStop& stop) {
  const std::size_t end = std::min(text.find('<', stop.token), text.size());
  if (auto found = fault_of_references(text, stop.token, end)) return *found;
  if (stop.open.empty()) return {skip_blanks(text, stop.token), "text outside of the root element", {}};
  const std::size_t bracket = text.substr(0, end).find("]]>", stop.token);
  if (bracket != none) return {bracket, "']]>' cannot stand in text", "write ']]&gt;'"};
  return {stop.byte, "not well-formed XML: " + stop.reason, {}};
}

XmlFault fault_of_comment(std::string_view text, std::size_t begin) {
  const std::size_t end = text.find("--", begin + 4);
  if (end == none) return {begin, "the comment never ends: '--' is missing", {}};
  return {end, "'--' cannot stand inside of a comment", {}};
}

XmlFault fault_of_cdata(std::string_view text, const XmlStop& stop) {
  const std::size_t begin = stop.token + 9, end = text.find("]]>", begin);
  if (end == none) return {stop.token, "the CDATA section never ends: ']]>' is missing", {}};
  const std::size_t first = skip_blanks(text, begin);
  return {first < end ? first : stop.token, "text outside of the root element", {}};
}

XmlFault fault_of_instruction(std::string_view text, const XmlStop& stop) {
  const std::string_view rest = text.substr(stop.token);
  const bool declaration = rest.size() > 5 && rest.starts_with("<?xml") && blanks.find(rest[5]) != none;
  const bool first = text.substr(0, stop.token).empty() || text.substr(0, stop.token) == "\xEF\xBB\xBF";
  if (declaration && !first) {
    return {stop.token, "the declaration '<?xml ...?>' can only begin the file", "remove what stands before it"};
  }
  if (text.find("?>", stop.token + 2) == none) {
    return {stop.token, "the processing instruction never ends: '?>' is missing", {}};
  }
  return {stop.token, "a processing instruction begins with a name that is not 'xml'", {}};
}

}  // namespace

std::optional<XmlFault> fault_of_characters(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = character_bytes(text, i);
    if (bytes == 0) return XmlFault{i, "this is not UTF-8 text", "save the file as UTF-8"};
    const char c = text[i];
    if (bytes == 1 && static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') {
      return XmlFault{i, "XML allows no control characters", {}};
    }
    if (const auto whole = text.substr(i, bytes); whole == "\uFFFE" || whole == "\uFFFF") {
      return XmlFault{i, "U+FFFE and U+FFFF are no characters", {}};
    }
    i += bytes;
  }
  return std::nullopt;
}

XmlFault xml_fault(std::string_view text, const XmlStop& stop) {
  const std::string_view rest = text.substr(stop.token);
  if (rest.find_first_not_of(blanks) == none) {
    return stop.open.empty() ? XmlFault{0, "the file holds no element: it is empty", {}} : unclosed(stop.open.back());
  }
  if (!rest.starts_with('<')) return fault_of_text(text, stop);
  if (rest.starts_with("<!--")) return fault_of_comment(text, stop.token);
  if (rest.starts_with("<![CDATA[")) return fault_of_cdata(text, stop);
  if (rest.starts_with("<?")) return fault_of_instruction(text, stop);
  if (rest.starts_with("<!")) {
    return {stop.token, "a document type (<!DOCTYPE>) with its entities is not allowed",
            "remove it and write the text out"};
  }
  if (rest.starts_with("</")) return fault_of_end_tag(text, stop);
  if (auto found = StartTag(text, stop.token).fault()) return *found;
  if (stop.open.empty() && stop.has_root) return {stop.token, "a second root element; a file holds one", {}};
  return {stop.byte, "XML does not allow this character in a name", {}};
}

}  // namespace freeplay
