#include "urdf/xml_document.h"

#include <algorithm>
#include <charconv>
#include <cstddef>

#include <fmt/format.h>

#include "base/text.h"

namespace freeplay {
namespace {

constexpr std::size_t deepest_level = 64, most_parts = 1'000'000, most_attributes = 64;
constexpr std::string_view blanks = " \t\r\n";

/// Ends the parsing after the mistake has been reported.
struct Abandon {};

bool is_name_character(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80 || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == ':' || c == '-' || c == '.';
}

bool begins_name(char c) { return is_name_character(c) && !(c >= '0' && c <= '9') && c != '-' && c != '.'; }

bool is_allowed(unsigned long code) {
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code == '\t' || code == '\n' || code == '\r' ||
         (code >= 0x20 && code <= 0x10FFFF && !surrogate && code != 0xFFFE && code != 0xFFFF);
}

void append_utf8(std::string& out, unsigned long code) {
  const auto byte = [&](unsigned long bits) { out += static_cast<char>(static_cast<unsigned char>(bits)); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xC0 | (code >> 6));
  } else {
    if (code < 0x10000) {
      byte(0xE0 | (code >> 12));
    } else {
      byte(0xF0 | (code >> 18));
      byte(0x80 | ((code >> 12) & 0x3F));
    }
    byte(0x80 | ((code >> 6) & 0x3F));
  }
  byte(0x80 | (code & 0x3F));
}

class XmlParser {
 public:
  XmlParser(std::string_view text, const std::string& file_name, const char* id, Diagnostics& diagnostics)
      : text_(text), file_(file_name), id_(id), diagnostics_(diagnostics), places_(text) {}

  XmlElement parse() {
    require_characters();
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    while (at_ < text_.size()) step();
    if (!open_.empty()) fail_unclosed();
    if (!seen_root_) fail({1, 1}, "the file holds no element: it is empty");
    return std::move(root_);
  }

 private:
  struct Open {
    XmlElement* element;
    std::size_t content;  ///< where its start tag ends
  };

  [[noreturn]] void fail(const TextPlace& at, const std::string& message, const std::string& hint = {},
                         const char* id = nullptr) {
    diagnostics_.error({file_, at.line, at.column}, 1, id == nullptr ? id_ : id, message, {}, hint);
    throw Abandon();
  }
  [[noreturn]] void fail(std::size_t position, const std::string& message, const std::string& hint = {}) {
    fail(TextPlaces(text_).at(position), message, hint);
  }
  [[noreturn]] void fail_unclosed() {
    fail(open_.back().content,
         fmt::format("the element '{}' is opened here and never closed", open_.back().element->name));
  }

  void require_characters() {
    for (std::size_t i = 0; i < text_.size();) {
      const std::size_t bytes = character_bytes(text_, i);
      if (bytes == 0) fail(i, "this is not UTF-8 text", "save the file as UTF-8");
      if (bytes == 1 && !is_allowed(static_cast<unsigned char>(text_[i]))) fail(i, "XML allows no control characters");
      if (const auto c = text_.substr(i, bytes); c == "\uFFFE" || c == "\uFFFF") {
        fail(i, "U+FFFE and U+FFFF are no characters");
      }
      i += bytes;
    }
  }

  // --- structure -------------------------------------------------------------------------------------------------

  void step() {
    if (text_[at_] != '<') return read_text();
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("<!--")) return read_comment();
    if (rest.size() > 5 && rest.starts_with("<?xml") && blanks.find(rest[5]) != std::string_view::npos) {
      check_declaration();
    }
    if (rest.starts_with("<?")) return skip_past("?>", 2, "the processing instruction");
    if (rest.starts_with("<![CDATA[")) return read_cdata();
    if (rest.starts_with("<!")) {
      fail(at_, "a document type (<!DOCTYPE>) with its entities is not allowed", "remove it and write the text out");
    }
    if (rest.starts_with("</")) return read_end_tag();
    read_start_tag();
  }

  /// The XML declaration is the very beginning, and the text is what its encoding says: it has been read as UTF-8.
  void check_declaration() {
    const bool first = at_ == 0 || (at_ == 3 && text_.starts_with("\xEF\xBB\xBF"));
    if (!first) fail(at_, "the declaration '<?xml ...?>' can only begin the file", "remove what stands before it");
    const std::string_view declaration = text_.substr(at_, text_.find("?>", at_) - at_);
    const std::size_t key = declaration.find("encoding"), quote = declaration.find_first_of("\"'", key);
    if (key == std::string_view::npos || quote == std::string_view::npos) return;
    const std::string_view rest = declaration.substr(quote + 1);
    std::string encoding(rest.substr(0, rest.find(declaration[quote])));
    for (char& c : encoding) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const auto begins = [&](const char* word) { return encoding.starts_with(word); };
    const bool wide = begins("utf-16") || begins("utf-32") || begins("ucs") || begins("iso-10646");
    const bool ascii = std::ranges::all_of(text_, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
    if (encoding == "utf-8" || (ascii && !wide)) return;
    fail(at_ + quote + 1, fmt::format("the file says that it is '{}', but it is UTF-8", encoding),
         "write encoding=\"UTF-8\"");
  }

  /// `head`: bytes at the beginning that are no part of the end.
  void skip_past(std::string_view end, std::size_t head, const char* what) {
    const std::size_t found = text_.find(end, at_ + head);
    if (found == std::string_view::npos) fail(at_, fmt::format("{} never ends: '{}' is missing", what, end));
    at_ = found + end.size();
  }

  void read_comment() {
    skip_past("--", 4, "the comment");
    if (at_ >= text_.size() || text_[at_] != '>') fail(at_ - 2, "'--' cannot stand inside of a comment");
    ++at_;
  }

  void read_cdata() {
    const std::size_t begin = at_ + 9, end = text_.find("]]>", begin);
    if (end == std::string_view::npos) fail(at_, "the CDATA section never ends: ']]>' is missing");
    add_text(begin, text_.substr(begin, end - begin));
    at_ = end + 3;
  }

  void read_text() {
    const std::size_t begin = at_, end = std::min(text_.find('<', at_), text_.size());
    at_ = end;
    add_text(begin, resolved(begin, end));
  }

  void add_text(std::size_t begin, std::string_view content) {
    const std::size_t first = text_.substr(begin).find_first_not_of(blanks);
    if (content.find_first_not_of(blanks) == std::string_view::npos) return;
    if (open_.empty()) fail(begin + first, "text outside of the root element");
    XmlElement& element = *open_.back().element;
    if (element.text.empty()) element.text_place = places_.at(begin + first);
    element.text += content;
  }

  void read_start_tag() {
    const std::size_t begin = at_++;
    if (at_ >= text_.size() || !begins_name(text_[at_])) fail(begin, "a name must follow '<'", "write '&lt;' in text");
    XmlElement element;
    element.place = places_.at(begin);
    element.name_place = places_.at(at_);
    element.name = read_name();
    count();
    const bool closed = read_attributes(element);
    if (open_.empty() && seen_root_) fail(begin, "a second root element; a file holds one");
    XmlElement& kept =
        open_.empty() ? root_ = std::move(element) : open_.back().element->children.emplace_back(std::move(element));
    seen_root_ = true;
    if (closed) return;
    if (open_.size() == deepest_level) fail(kept.place, "more than 64 levels of elements", {}, "too-large");
    open_.push_back({&kept, at_});
  }

  void read_end_tag() {
    const std::size_t begin = at_;
    at_ += 2;
    const std::string name = at_ < text_.size() && begins_name(text_[at_]) ? read_name() : std::string();
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != '>') {
      fail(begin, fmt::format("an end tag holds nothing but its name: </{}>", name.empty() ? "name" : name));
    }
    ++at_;
    const bool known = std::any_of(open_.begin(), open_.end(), [&](const Open& o) { return o.element->name == name; });
    if (!known) fail(begin, fmt::format("the end tag </{}> closes nothing", name));
    if (open_.back().element->name != name) fail_unclosed();
    open_.pop_back();
  }

  // --- inside of a tag -------------------------------------------------------------------------------------------

  void skip_blanks() { at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size()); }

  std::string read_name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_name_character(text_[at_])) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  /// True when the tag closes itself.
  bool read_attributes(XmlElement& element) {
    while (true) {
      const std::size_t behind = at_;
      skip_blanks();
      if (at_ >= text_.size()) fail(behind, fmt::format("the tag of '{}' is not closed: '>' is missing", element.name));
      if (text_[at_] == '>') return ++at_, false;
      if (text_.substr(at_).starts_with("/>")) return at_ += 2, true;
      if (!begins_name(text_[at_])) fail(at_, fmt::format("an attribute or '>' is expected in '{}'", element.name));
      if (at_ == behind) fail(at_, "a blank is missing between two attributes");
      read_attribute(element);
    }
  }

  void read_attribute(XmlElement& element) {
    XmlAttribute attribute;
    attribute.place = places_.at(at_);
    attribute.name = read_name();
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != '=') {
      fail(attribute.place, fmt::format("the attribute '{}' has no value", attribute.name));
    }
    ++at_;
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '"' && quote != '\'') {
      fail(attribute.place, fmt::format("the value of '{}' must stand in quotes", attribute.name));
    }
    const std::size_t begin = at_ + 1, end = text_.find(quote, begin);
    if (end == std::string_view::npos || text_.substr(begin, end - begin).find('<') != std::string_view::npos) {
      fail(attribute.place, fmt::format("the value of '{}' is not closed: {} is missing", attribute.name, quote));
    }
    attribute.value = resolved(begin, end);
    at_ = end + 1;
    if (element.attribute(attribute.name) != nullptr) {
      fail(attribute.place, fmt::format("the attribute '{}' is given twice", attribute.name));
    }
    count();
    if (element.attributes.size() == most_attributes) {
      fail(attribute.place, "more than 64 attributes in one element", {}, "too-large");
    }
    element.attributes.push_back(std::move(attribute));
  }

  void count() {
    if (++parts_ > most_parts) fail({1, 1}, "more than 1 000 000 elements and attributes", {}, "too-large");
  }

  // --- references ------------------------------------------------------------------------------------------------

  std::string resolved(std::size_t begin, std::size_t end) {
    const std::string_view raw = text_.substr(begin, end - begin);
    std::string out;
    std::size_t from = 0;
    for (std::size_t sign = raw.find('&'); sign != std::string_view::npos; sign = raw.find('&', from)) {
      out += raw.substr(from, sign - from);
      const std::size_t close = raw.find(';', sign);
      if (close == std::string_view::npos) fail(begin + sign, "'&' begins a reference; write '&amp;'");
      append_reference(out, begin + sign, raw.substr(sign + 1, close - sign - 1));
      from = close + 1;
    }
    return out += raw.substr(from);
  }

  void append_reference(std::string& out, std::size_t position, std::string_view name) {
    constexpr std::pair<std::string_view, char> known[] = {
        {"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
    for (const auto& [word, character] : known) {
      if (name == word) {
        out += character;
        return;
      }
    }
    const std::string written = fmt::format("&{};", std::string(name.substr(0, 32)));
    if (name.starts_with('#')) {
      const bool hexadecimal = name.starts_with("#x");
      name.remove_prefix(hexadecimal ? 2 : 1);
      unsigned long code = 0;
      const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), code, hexadecimal ? 16 : 10);
      const bool whole = !name.empty() && error != std::errc::invalid_argument && stop == name.data() + name.size();
      if (whole && error == std::errc() && is_allowed(code)) return append_utf8(out, code);
      fail(position,
           fmt::format("'{}' {}", written,
                       whole ? "stands for a character that XML does not allow" : "is not the number of a character"));
    }
    fail(position, fmt::format("unknown entity '{}'", written));
  }

  std::string_view text_;
  std::string file_;
  const char* id_;
  Diagnostics& diagnostics_;
  TextPlaces places_;
  std::size_t at_ = 0, parts_ = 0;
  XmlElement root_;
  bool seen_root_ = false;
  std::vector<Open> open_;
};

}  // namespace

const XmlAttribute* XmlElement::attribute(std::string_view wanted) const {
  const auto found = std::ranges::find(attributes, wanted, &XmlAttribute::name);
  return found == attributes.end() ? nullptr : &*found;
}

const XmlElement* XmlElement::child(std::string_view wanted) const {
  const auto found = std::ranges::find(children, wanted, &XmlElement::name);
  return found == children.end() ? nullptr : &*found;
}

std::optional<XmlElement> parse_xml(std::string_view text, const std::string& file_name, const char* id,
                                    Diagnostics& diagnostics) {
  try {
    return XmlParser(text, file_name, id, diagnostics).parse();
  } catch (const Abandon&) {
    return std::nullopt;
  }
}

}  // namespace freeplay
