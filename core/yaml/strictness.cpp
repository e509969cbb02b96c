#include "yaml/strictness.h"

#include <algorithm>

#include "base/text.h"

namespace freeplay {
namespace {

constexpr const char* comment_without_blank = "a comment needs a blank before its '#'";
constexpr std::size_t none = std::string_view::npos;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

bool is_one_of(char c, std::string_view set) { return set.find(c) != none; }

std::size_t line_end(std::string_view text, std::size_t at) { return std::min(text.find('\n', at), text.size()); }

/// Number of blanks at the beginning of a line; tabs do not indent.
int indentation(std::string_view text, std::size_t line_begin) {
  const std::size_t end = text.find_first_not_of(' ', line_begin);
  return static_cast<int>(std::min(end, text.size()) - line_begin);
}

constexpr int none_open = -1;

/// May the lines that follow be the text of a block scalar? True also of some plain values that end alike.
bool opens_block_scalar(std::string_view line) {
  for (std::size_t at = line.find_first_of("|>"); at != none; at = line.find_first_of("|>", at + 1)) {
    const std::size_t end = line.find_first_not_of("+-0123456789", at + 1);
    const std::size_t next = line.find_first_not_of(" \t\r", end);
    if (end == none || next == none || (next > end && line[next] == '#')) return true;
  }
  return false;
}

/// A line that continues a value must be indented by blanks. Between brackets comments need not be; and a bracket that
/// closes may stand below the key, as many people write it, although YAML is stricter there.
std::optional<YamlFault> find_indentation_fault(std::string_view text, std::size_t line_begin, int indent,
                                                bool between_brackets) {
  const int blanks = indentation(text, line_begin);
  const std::size_t first = line_begin + static_cast<std::size_t>(blanks);
  const std::size_t content = text.find_first_not_of(" \t\r", line_begin);
  if (content == none || text[content] == '\n' || blanks > indent) return std::nullopt;
  if (between_brackets && text[content] == '#') return std::nullopt;
  if (text[first] == '\t') return YamlFault{first, "a tab cannot indent a line", "indent with blanks"};
  if (!between_brackets) return YamlFault{first, "this line of a quoted text must be indented"};
  if (is_one_of(text[first], "]}")) return std::nullopt;
  return YamlFault{first, "this line between brackets must be indented more than the lines around the brackets"};
}

/// Walks through a list in brackets or a map in braces.
class FlowScanner {
 public:
  FlowScanner(std::string_view text, std::size_t begin, int indent) : text_(text), at_(begin), indent_(indent) {}

  std::optional<YamlFault> scan() {
    do {
      if (auto fault = step()) return fault;
    } while (depth_ > 0 && at_ < text_.size());
    if (depth_ > 0) return std::nullopt;  // an open bracket is the fault, and the parser reports it
    if (outdented_) return outdented_;
    if (at_ < text_.size() && text_[at_] == '#') return YamlFault{at_, comment_without_blank};
    return std::nullopt;
  }

 private:
  std::optional<YamlFault> step() {
    const char c = text_[at_];
    if (c == '\n') return line();
    if (is_blank(c)) {
      ++at_;
    } else if (c == '#' && is_blank(text_[at_ - 1])) {
      at_ = line_end(text_, at_);
    } else if (is_one_of(c, "[]{},")) {
      return indicator(c);
    } else if (token_begins_ && is_one_of(c, "\"'")) {
      at_ = std::min(quoted_end(text_, at_), text_.size());
      content(true);
    } else if (token_begins_ && is_one_of(c, "&!")) {
      at_ = std::min(text_.find_first_of(" \t\r\n,[]{}", at_), text_.size());
      entry_begins_ = false;
    } else if (token_begins_ && c == '-' && ends_token(at_ + 1)) {
      return YamlFault{at_, "a '-' cannot be an entry between brackets"};
    } else {
      const bool colon = is_one_of(c, ":?") && (ends_token(at_ + 1) || (c == ':' && after_json_));
      ++at_;
      content(false);
      token_begins_ = colon;
    }
    return std::nullopt;
  }

  std::optional<YamlFault> line() {
    const std::optional<YamlFault> fault = find_indentation_fault(text_, ++at_, indent_, true);
    if (fault && text_[fault->position] == '\t') return fault;
    if (!outdented_) outdented_ = fault;
    return std::nullopt;
  }

  std::optional<YamlFault> indicator(char c) {
    if (c == ',' && entry_begins_) return YamlFault{at_, "an entry is missing before this comma"};
    ++at_;
    const bool opens = c == '[' || c == '{', closes = c == ']' || c == '}';
    depth_ += opens ? 1 : closes ? -1 : 0;
    token_begins_ = entry_begins_ = !closes;
    after_json_ = closes;
    if (!closes && at_ < text_.size() && text_[at_] == '#') return YamlFault{at_, comment_without_blank};
    return std::nullopt;
  }

  void content(bool quoted) {
    token_begins_ = entry_begins_ = false;
    after_json_ = quoted;
  }

  bool ends_token(std::size_t at) const {
    return at >= text_.size() || is_blank(text_[at]) || is_one_of(text_[at], ",[]{}");
  }

  std::string_view text_;
  std::size_t at_;
  int indent_;
  int depth_ = 0;
  std::optional<YamlFault> outdented_;  // the first line with too few blanks
  bool token_begins_ = true;            // a quote would open a quoted scalar here
  bool entry_begins_ = false;           // nothing of the entry has come
  bool after_json_ = false;             // after a quoted scalar or a bracket a ':' needs no blank
};

}  // namespace

std::optional<YamlFault> find_bad_character(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    const std::size_t length = character_bytes(text, i);
    if (length == 0) return YamlFault{i, "this byte is not UTF-8", "save the file as UTF-8"};
    // Next line (U+0085) is the only control character beyond ASCII that YAML lets pass.
    const bool c1 = c == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0 && text[i + 1] != '\x85';
    if ((c < 0x20 && !is_blank(text[i])) || c == 0x7F || c1) {
      return YamlFault{i, "a control character cannot stand in the file"};
    }
    const std::string_view character = text.substr(i, length);
    if (character == "\uFFFE" || character == "\uFFFF") {
      return YamlFault{i, "U+FFFE and U+FFFF are no characters and cannot stand in the file"};
    }
    i += length;
  }
  return std::nullopt;
}

std::string without_tabs_in_empty_lines(std::string text) {
  int block = none_open;  // blanks before the line that opens the block scalar around
  for (std::size_t at = 0; at < text.size(); at = line_end(text, at) + 1) {
    const std::size_t content = text.find_first_not_of(" \t\r", at);
    const bool empty = content == none || text[content] == '\n';
    const int blanks = indentation(text, at);
    if (block != none_open && (empty || blanks > block)) continue;
    block = opens_block_scalar(std::string_view(text).substr(at, line_end(text, at) - at)) ? blanks : none_open;
    if (!empty && text[content] != '#') continue;
    for (std::size_t i = at; i < text.size() && is_one_of(text[i], " \t"); ++i) text[i] = ' ';
  }
  return text;
}

std::optional<YamlFault> find_directive_fault(std::string_view text, bool map) {
  constexpr const char* alone = "a line that begins with '%' is a directive and needs a '---' after it";
  std::size_t directive = none;
  bool content = false;
  for (std::size_t at = 0; at < text.size(); at = line_end(text, at) + 1) {
    if (text[at] == '%' && (map || !content)) {
      if (content) return YamlFault{at, "a line cannot begin with '%' here", "quote the value"};
      directive = at;
    }
    const std::size_t first = text.find_first_not_of(" \t\r", at);
    if (content || text[at] == '%' || first == none || is_one_of(text[first], "\n#")) continue;
    if (directive != none && !text.substr(at).starts_with("---")) return YamlFault{directive, alone};
    content = true;
  }
  if (directive != none && !content) return YamlFault{directive, alone};
  return std::nullopt;
}

std::optional<YamlFault> find_flood(std::string_view text) {
  // A line of 1 000 000 values, the most that a file may hold, has fewer signs; nesting beyond 64 levels is refused
  // with more care where the parser bears it.
  constexpr int most_signs = 1'500'000, most_open = 10'000;
  int open = 0, signs = 0;
  std::size_t outermost = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') signs = 0;
    if (!is_one_of(c, "[]{},")) continue;
    if (++signs > most_signs) return YamlFault{outermost, "more than 1 000 000 values"};
    if (is_one_of(c, "[{")) {
      if (open == 0) outermost = i;
      if (++open > most_open) return YamlFault{outermost, "more than 64 levels of nesting"};
    } else if (c != ',') {
      open = std::max(0, open - 1);
    }
  }
  return std::nullopt;
}

std::optional<YamlFault> find_flow_fault(std::string_view text, std::size_t begin, int indent) {
  return FlowScanner(text, begin, indent).scan();
}

std::optional<YamlFault> find_quoted_fault(std::string_view text, std::size_t begin, int indent) {
  const std::size_t end = quoted_end(text, begin);
  if (end == none) return YamlFault{begin, "this quote is never closed"};
  for (std::size_t i = begin + 1; i < end; ++i) {
    if (text[i] == '\n') {
      if (auto fault = find_indentation_fault(text, i + 1, indent, false)) return fault;
    } else if (text[begin] == '"' && text[i] == '\\' && i + 1 < end) {
      if (!is_one_of(text[i + 1], "0abt\tnvfre \"/\\N_LPxuU\r\n")) {
        return YamlFault{i, "this escape is unknown", "write '\\\\' for a backslash, or use single quotes"};
      }
      i += text[i + 1] == '\n' ? 0 : 1;
    }
  }
  if (end < text.size() && text[end] == '#') return YamlFault{end, comment_without_blank};
  return std::nullopt;
}

std::optional<YamlFault> find_block_scalar_fault(std::string_view text, std::size_t begin, int indent) {
  const std::size_t header_end = line_end(text, begin);
  const std::string_view header = text.substr(begin, header_end - begin);
  const std::size_t next = header.find_first_not_of("+-0123456789", 1);
  if (next != none && header[next] == '#') return YamlFault{begin + next, comment_without_blank};
  if (header.substr(0, header.find('#')).find_first_of("123456789") != none) return std::nullopt;
  int widest = 0;
  std::size_t widest_begin = header_end;
  for (std::size_t at = header_end + 1; at < text.size(); at = line_end(text, at) + 1) {
    const int blanks = indentation(text, at);
    const std::size_t content = at + static_cast<std::size_t>(blanks);
    const bool empty = content >= text.size() || is_one_of(text[content], "\r\n");
    if (!empty) {
      if (blanks > indent && blanks < widest) return YamlFault{widest_begin, "this empty line has too many blanks"};
      return std::nullopt;
    }
    if (blanks > widest) {
      widest = blanks;
      widest_begin = at;
    }
  }
  return std::nullopt;
}

std::size_t quoted_end(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  for (std::size_t i = begin + 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      const bool doubled = quote == '\'' && i + 1 < text.size() && text[i + 1] == quote;
      if (!doubled) return i + 1;
      ++i;
    }
  }
  return none;
}

}  // namespace freeplay
