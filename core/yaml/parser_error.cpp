#include "yaml/parser_error.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include <yaml-cpp/exceptions.h>

namespace freeplay {
namespace {

struct Explanation {
  std::string_view library_message, message, hint;
};

// What the common messages of the parser mean for the author of a model.
constexpr Explanation explanations[] = {
    {"end of sequence flow not found", "this '[' is not closed before the text goes on", "add ']' or a comma"},
    {"end of map flow not found", "this '{' is not closed before the text goes on", "add '}' or a comma"},
    {"end of map not found", "this line is indented unlike the lines it belongs to", ""},
    {"end of sequence not found", "this line is indented unlike the list it belongs to", ""},
    {"illegal map value", "a ':' cannot stand here", "quote a value that contains ': '"},
    {"unknown token", "a value cannot begin with this character", "quote the value"},
    {"the referenced anchor is not defined", "the alias names an anchor that is not defined before it", ""},
};

/// What a faulty escape means; the parser stands after it.
std::optional<Explanation> explain_escape(const std::string& message) {
  if (message == YAML::ErrorMsg::INVALID_HEX) {
    return Explanation{"", "this escape is not complete",
                       "'\\x' needs 2 hexadecimal digits, '\\u' 4 and '\\U' 8; write '\\\\' for a backslash"};
  }
  if (message.starts_with(YAML::ErrorMsg::INVALID_ESCAPE)) {
    return Explanation{"", "this escape is unknown", "write '\\\\' for a backslash, or use single quotes"};
  }
  if (message.starts_with(YAML::ErrorMsg::INVALID_UNICODE)) {
    return Explanation{"", "this escape names no character", "surrogates and codes above 10FFFF are none"};
  }
  return std::nullopt;
}

/// What the parser reports at its next line or next word although the mistake stands before, or does not say rightly.
/// The position moves there.
std::optional<Explanation> explain_in_line(const std::string& message, std::string_view text, std::size_t& position) {
  if (const auto escape = explain_escape(message)) {
    const std::size_t begin = position == 0 ? std::string_view::npos : text.find_last_of('\\', position - 1);
    if (begin == std::string_view::npos) return std::nullopt;
    position = begin;
    return escape;
  }
  if (position >= text.size()) return std::nullopt;
  const std::size_t line_begin = position == 0 ? 0 : text.find_last_of('\n', position - 1) + 1;
  const std::size_t first = text.find_first_not_of(" \t", line_begin);
  constexpr std::size_t longest_key = 1024;
  if (message == YAML::ErrorMsg::MAP_VALUE && position > first + longest_key) {
    position = first;
    return Explanation{"", "a key has at most 1024 characters", ""};
  }
  if (message == YAML::ErrorMsg::UNKNOWN_TOKEN && text[position] == '?') {
    return Explanation{"", "a word that begins with '?' is not read between brackets", "quote it"};
  }
  if (message != YAML::ErrorMsg::END_OF_MAP && message != YAML::ErrorMsg::END_OF_SEQ) return std::nullopt;
  if (first >= position) return std::nullopt;
  if (text[position] == '*')
    return Explanation{"", "an alias cannot stand after something else", "it is a whole value"};
  const char before = text[text.find_last_not_of(" \t", position - 1)];
  if (before == ':' || before == '-')
    return Explanation{"", "a value cannot begin with this character", "quote the value"};
  return Explanation{"", "the value before this has ended already", "quote the value as a whole"};
}

/// Does the parser stumble, at `position`, over a key that it lost because a line ends in it? It does so at the key's
/// begin in braces, in brackets at its ':'.
bool is_long_key(std::string_view text, std::size_t position) {
  const std::size_t before = position == 0 ? std::string_view::npos : text.find_last_not_of(" \t\r\n", position - 1);
  if (before == std::string_view::npos) return false;
  if (text[position] != ':') return text[before] == '{' || text[before] == ',';
  const std::size_t begin = text.find_last_of("[{,", before);
  if (begin == std::string_view::npos || text.substr(begin, before - begin).find('\n') == std::string_view::npos) {
    return false;
  }
  // Where the bracket is never closed, that is the mistake.
  int depth = 1;
  for (std::size_t i = begin + 1; i < text.size() && depth > 0; ++i) {
    depth += text[i] == '[' || text[i] == '{' ? 1 : text[i] == ']' || text[i] == '}' ? -1 : 0;
  }
  return depth == 0;
}

}  // namespace

void report_parser_error(const YAML::Exception& error, const Document& document, const TextPlace& innermost,
                         Diagnostics& diagnostics) {
  const std::string& text = document.text();
  auto position = error.mark.is_null() ? text.size() : static_cast<std::size_t>(error.mark.pos);
  const std::size_t line_begin = position == 0 ? 0 : text.find_last_of('\n', position - 1) + 1;
  const std::size_t tab = text.find_first_not_of(' ', line_begin);
  if (tab < text.size() && text[tab] == '\t') {
    const TextPlace at = TextPlaces(text).at(tab);
    diagnostics.error({document.file_name(), at.line, at.column}, 1, "yaml-syntax", "a tab cannot indent a line", {},
                      "indent with blanks");
    return;
  }
  std::optional<Explanation> in_line = explain_in_line(error.msg, text, position);
  TextPlace at = TextPlaces(text).at(position);
  // The parser notices only at the next line that a bracket is open.
  const bool open = error.msg == YAML::ErrorMsg::END_OF_SEQ_FLOW || error.msg == YAML::ErrorMsg::END_OF_MAP_FLOW;
  if (open && position < text.size() && is_long_key(text, position)) {
    in_line = Explanation{"", "a key between brackets goes over more than one line here", "write it on one line"};
  } else if (open) {
    at = innermost;
  }
  const Explanation* known = std::find_if(std::begin(explanations), std::end(explanations),
                                          [&](const Explanation& e) { return e.library_message == error.msg; });
  if (in_line) known = &*in_line;
  const bool explained = known != std::end(explanations);
  diagnostics.error({document.file_name(), at.line, at.column}, 1, "yaml-syntax",
                    explained ? std::string(known->message) : "not valid YAML: " + error.msg, {},
                    explained ? std::string(known->hint) : std::string());
}

}  // namespace freeplay
