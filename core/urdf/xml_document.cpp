#include "urdf/xml_document.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <expat.h>
#include <fmt/format.h>

#include "urdf/blanks.h"
#include "urdf/xml_fault.h"

namespace freeplay {
namespace {

constexpr std::size_t deepest_level = 64, most_parts = 1'000'000;
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// Has Expat read a text: keeps the places of its elements, or reports why it is no document that is taken here.
class StrictReader {
 public:
  StrictReader(std::string_view text, const std::string& file_name, const char* id, Diagnostics& diagnostics)
      : text_(text),
        file_(file_name),
        id_(id),
        diagnostics_(diagnostics),
        text_places_(text),
        parser_(XML_ParserCreate("UTF-8"), XML_ParserFree) {
    if (text.starts_with(byte_order_mark)) stop_.token = byte_order_mark.size();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_characters);
    XML_SetCdataSectionHandler(parser_.get(), on_cdata, on_other);
    XML_SetProcessingInstructionHandler(parser_.get(), on_instruction);
    XML_SetXmlDeclHandler(parser_.get(), on_declaration);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_document_type);
    XML_SetDefaultHandler(parser_.get(), on_rest);
  }

  bool read() {
    // Not left to Expat, which takes UTF-16 for what it is, whatever encoding it is given.
    if (const auto fault = fault_of_characters(text_)) {
      fail(*fault);
      return false;
    }
    pass_declaration();
    begin_ = stop_.token;
    const std::string_view rest = text_.substr(begin_);
    const auto status =
        failed_ ? XML_STATUS_ERROR : XML_Parse(parser_.get(), rest.data(), static_cast<int>(rest.size()), XML_TRUE);
    if (failed_ || status == XML_STATUS_OK) return !failed_;
    stop_.byte = token().begin;
    stop_.reason = XML_ErrorString(XML_GetErrorCode(parser_.get()));
    if (XML_GetErrorCode(parser_.get()) == XML_ERROR_UNCLOSED_CDATA_SECTION) stop_.token = cdata_;
    refuse();
    return false;
  }

  std::vector<XmlPlaces> places() { return std::move(places_); }

  /// The text without processing instructions: tinyxml2 takes none after the declaration.
  std::string without_instructions() const {
    std::string out;
    std::size_t from = 0;
    for (const auto& [begin, end] : instructions_) {
      out += text_.substr(from, begin - from);
      from = end;
    }
    return out += text_.substr(from);
  }

 private:
  struct Range {
    std::size_t begin, end;
  };

  // --- what Expat calls ------------------------------------------------------------------------------------------

  static StrictReader& of(void* self) { return *static_cast<StrictReader*>(self); }
  static void on_start(void* self, const XML_Char* name, const XML_Char**) { of(self).start(name); }
  static void on_end(void* self, const XML_Char*) { of(self).end(); }
  static void on_characters(void* self, const XML_Char*, int) { of(self).characters(); }
  static void on_cdata(void* self) {
    of(self).cdata_ = of(self).token().begin;
    of(self).pass();
  }
  static void on_instruction(void* self, const XML_Char*, const XML_Char*) {
    of(self).instructions_.push_back(of(self).token());
    of(self).pass();
  }
  static void on_declaration(void* self, const XML_Char*, const XML_Char*, int) { of(self).refuse(); }  // a second one
  static void on_document_type(void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    of(self).refuse();
  }
  static void on_other(void* self) { of(self).pass(); }
  static void on_rest(void* self, const XML_Char*, int) { of(self).pass(); }

  // --- what they do ----------------------------------------------------------------------------------------------

  Range token() const {
    const std::size_t begin = begin_ + static_cast<std::size_t>(XML_GetCurrentByteIndex(parser_.get()));
    return {begin, begin + static_cast<std::size_t>(XML_GetCurrentByteCount(parser_.get()))};
  }
  void pass() { stop_.token = token().end; }

  void start(const char* name) {
    const Range tag = token();
    const bool closed = text_[tag.end - 2] == '/';
    XmlPlaces& places = places_.emplace_back();
    places.begin = text_places_.at(tag.begin);
    places.name = text_places_.at(tag.begin + 1);
    if (!count()) return;
    if (!find_attributes(tag, places)) return;
    if (!closed && stop_.open.size() == deepest_level) {
      return fail(places.begin, "more than 64 levels of elements", {}, "too-large");
    }
    stop_.open.push_back({name, tag.end});
    open_.push_back(places_.size() - 1);
    stop_.has_root = true;
    pass();
  }

  void end() {
    if (failed_) return;
    stop_.open.pop_back();
    open_.pop_back();
    pass();
  }

  /// Expat has taken the tag, so that names, signs and quotes stand where they belong.
  bool find_attributes(const Range& tag, XmlPlaces& places) {
    const std::string_view raw = text_.substr(0, tag.end);
    std::size_t at = raw.find_first_of(" \t\r\n/>", tag.begin);
    while (true) {
      at = raw.find_first_not_of(blanks, at);
      if (raw[at] == '>' || raw[at] == '/') return true;
      const TextPlace place = text_places_.at(at);
      if (!count()) return false;
      if (places.attributes.size() == most_xml_attributes) {
        fail(place, "more than 64 attributes in one element", {}, "too-large");
        return false;
      }
      places.attributes.push_back(place);
      const std::size_t quote = raw.find_first_of("\"'", at);
      at = raw.find(raw[quote], quote + 1) + 1;
    }
  }

  void characters() {
    if (failed_) return;
    const Range piece = token();
    XmlPlaces& places = places_[open_.back()];
    const std::size_t first = text_.substr(0, piece.end).find_first_not_of(blanks, piece.begin);
    if (places.text.line == 0 && first != std::string_view::npos) places.text = text_places_.at(first);
    pass();
  }

  /// Passes over the declaration, of which only the encoding counts: other people's files misspell the rest.
  void pass_declaration() {
    const std::string_view rest = text_.substr(stop_.token);
    const std::size_t end = rest.find("?>");
    const bool named = rest.size() > 5 && rest.starts_with("<?xml");
    if (!named || (rest[5] != '?' && blanks.find(rest[5]) == std::string_view::npos)) return;
    check_encoding(stop_.token, rest.substr(0, end));
    if (end == std::string_view::npos || failed_) return;
    instructions_.push_back({stop_.token, stop_.token + end + 2});
    stop_.token += end + 2;
  }

  void check_encoding(std::size_t begin, std::string_view declaration) {
    const std::size_t key = declaration.find("encoding"), quote = declaration.find_first_of("\"'", key);
    if (key == std::string_view::npos || quote == std::string_view::npos) return;
    const std::string_view rest = declaration.substr(quote + 1);
    std::string encoding(rest.substr(0, rest.find(declaration[quote])));
    for (char& c : encoding) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const auto begins = [&](const char* word) { return encoding.starts_with(word); };
    const bool wide = begins("utf-16") || begins("utf-32") || begins("ucs") || begins("iso-10646");
    const bool ascii = std::ranges::all_of(text_, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
    if (encoding == "utf-8" || (ascii && !wide)) return;
    fail({begin + quote + 1, fmt::format("the file says that it is '{}', but it is UTF-8", encoding),
          "write encoding=\"UTF-8\""});
  }

  bool count() {
    if (++parts_ > most_parts) fail({1, 1}, "more than 1 000 000 elements and attributes", {}, "too-large");
    return !failed_;
  }

  /// Says what is wrong where Expat is.
  void refuse() {
    if (stop_.open.empty()) {  // blanks outside of the root are no text
      stop_.token = std::min(text_.find_first_not_of(blanks, stop_.token), text_.size());
    }
    fail(xml_fault(text_, stop_));
  }

  void fail(const XmlFault& fault) {
    fail(TextPlaces(text_).at(fault.position), fault.message, fault.hint, fault.too_large ? "too-large" : id_);
  }

  void fail(const TextPlace& at, const std::string& message, const std::string& hint, const char* id) {
    if (!failed_) diagnostics_.error({file_, at.line, at.column}, 1, id, message, {}, hint);
    failed_ = true;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  std::string_view text_;
  std::string file_;
  const char* id_;
  Diagnostics& diagnostics_;
  TextPlaces text_places_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  XmlStop stop_;
  std::vector<XmlPlaces> places_;
  std::vector<std::size_t> open_;  ///< places of the elements in stop_.open
  std::vector<Range> instructions_;
  std::size_t begin_ = 0;  ///< of what Expat reads
  std::size_t cdata_ = 0, parts_ = 0;
  bool failed_ = false;
};

/// The next element in the order of the start tags, or null.
XmlElement* next_of(XmlElement* element) {
  if (XmlElement* child = element->FirstChildElement()) return child;
  for (tinyxml2::XMLNode* up = element; up != nullptr; up = up->Parent()) {
    if (XmlElement* sibling = up->NextSiblingElement()) return sibling;
  }
  return nullptr;
}

const XmlPlaces beginning = {{1, 1}, {1, 1}, {1, 1}, {}};

}  // namespace

const XmlPlaces& places_of(const XmlElement& element) {
  const auto* places = static_cast<const XmlPlaces*>(element.GetUserData());
  return places == nullptr ? beginning : *places;
}

const TextPlace* place_of(const XmlElement& element, const XmlAttribute& attribute) {
  const XmlPlaces& places = places_of(element);
  std::size_t index = 0;
  for (const XmlAttribute* at = element.FirstAttribute(); at != &attribute; at = at->Next()) ++index;
  return index < places.attributes.size() ? &places.attributes[index] : nullptr;
}

std::string text_of(const XmlElement& element) {
  std::string out;
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr; node = node->NextSibling()) {
    const std::string_view piece = node->ToText() == nullptr ? "" : node->Value();
    if (piece.find_first_not_of(blanks) != std::string_view::npos) out += piece;
  }
  return out;
}

std::unique_ptr<XmlDocument> parse_xml(std::string_view text, const std::string& file_name, const char* id,
                                       Diagnostics& diagnostics) {
  StrictReader strict(text, file_name, id, diagnostics);
  if (!strict.read()) return nullptr;
  auto out = std::make_unique<XmlDocument>();
  const std::string plain = strict.without_instructions();
  if (out->document_.Parse(plain.data(), plain.size()) != tinyxml2::XML_SUCCESS) {
    diagnostics.error({file_name, out->document_.ErrorLineNum(), 1}, 1, id,
                      fmt::format("tinyxml2 does not take this: {}", out->document_.ErrorName()));
    return nullptr;
  }
  out->places_ = strict.places();
  std::size_t index = 0;
  for (XmlElement* element = &out->root(); element != nullptr; element = next_of(element)) {
    element->SetUserData(&out->places_[index++]);
  }
  return out;
}

}  // namespace freeplay
