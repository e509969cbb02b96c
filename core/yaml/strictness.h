// YamlStrictness: faults of a YAML text that the parser library (yaml-cpp 0.7) does not see.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace freeplay {

/// A violation of the YAML specification, `yaml-syntax`.
struct YamlFault {
  std::size_t position;  ///< byte in the text
  const char* message;
  const char* hint = "";
};

/// A line that begins with '%' before the text without the '---' that must follow, or, where the text is a `map`,
/// later.
std::optional<YamlFault> find_directive_fault(std::string_view text, bool map);

/// For the parser alone, which takes a tab in an empty line, or before a comment that has a line of its own, for
/// indentation: there blanks stand for tabs. Block scalars, where tabs are text, stay as they are. No byte moves.
std::string without_tabs_in_empty_lines(std::string text);

// In the functions below `begin` is the byte where the value begins, and `indent` the number of blanks before the
// innermost block list or map around it, -1 if there is none. They stop at the end of the value; what is not closed is
// left to the parser.

/// The first byte that is not UTF-8 or character that YAML forbids, in a text without byte-order mark.
std::optional<YamlFault> find_bad_character(std::string_view text);

/// So many brackets and commas that the parser, which reads a line with brackets ahead, would run out of memory before
/// it says anything. No sound text comes near, wherever it has its brackets; `too-large`.
std::optional<YamlFault> find_flood(std::string_view text);

/// In a list in brackets or map in braces: missing entries, a dash as entry, a comment without a blank before it,
/// indentation by tabs or by too few blanks.
std::optional<YamlFault> find_flow_fault(std::string_view text, std::size_t begin, int indent);

/// In a quoted scalar: a quote that is never closed, unknown escapes, lines that are not indented, a comment without a
/// blank before it.
std::optional<YamlFault> find_quoted_fault(std::string_view text, std::size_t begin, int indent);

/// In a block scalar (`|` or `>`): leading empty lines with more blanks than the first line of text, a comment without
/// a blank before it.
std::optional<YamlFault> find_block_scalar_fault(std::string_view text, std::size_t begin, int indent);

/// One past the quote that ends the scalar which begins with a quote at `begin`, or npos.
std::size_t quoted_end(std::string_view text, std::size_t begin);

}  // namespace freeplay
