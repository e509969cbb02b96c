#include "report/compact.h"

namespace freeplay {
namespace {

std::string_view next_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

void add_line(std::string& out, std::string_view line, const Syntax& syntax) {
  const auto is_mark = [&](char c) { return syntax.marks.find(c) != std::string_view::npos; };
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote == 0 && c == ' ') {
      if (line.find_first_not_of(' ', i) == line.find("//", i)) return;
      const char before = out.back(), after = i + 1 < line.size() ? line[i + 1] : ' ';
      const bool one_word = before == after && (before == '+' || before == '-');
      if ((is_mark(before) || is_mark(after)) && !one_word) continue;
    }
    if (quote == 0 && c == '}' && is_mark(c) && (out.back() == ';' || out.back() == '\n')) out.pop_back();
    if (quote != 0 && c == '\\') out += line[i++];
    if (quote != 0 ? c == quote : c == '\'' || c == '"') quote = quote != 0 ? 0 : c;
    out += line[i];
  }
}

}  // namespace

std::string compact(std::string_view source, const Syntax& syntax) {
  std::string out;
  while (!source.empty()) {
    std::string_view line = next_line(source);
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string_view::npos || line.substr(begin).starts_with("//")) continue;
    line.remove_prefix(begin);
    if (!out.empty() && syntax.ends.find(out.back()) == std::string_view::npos) out += '\n';
    add_line(out, line, syntax);
  }
  return out;
}

}  // namespace freeplay
