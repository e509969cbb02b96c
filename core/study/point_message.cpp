#include "study/point_message.h"

#include <algorithm>
#include <string_view>

#include "base/text.h"

namespace freeplay {
namespace {

bool is_path(std::string_view word, std::span<const std::string> folders) {
  if (word.starts_with('/')) return true;
  return std::ranges::any_of(
      folders, [&](const std::string& folder) { return !folder.empty() && word.starts_with(folder + "/"); });
}

}  // namespace

std::string point_message(const std::string& text, std::span<const std::string> folders) {
  std::string line;
  std::string_view rest = text;
  for (;;) {
    const std::size_t open = rest.find('\'');
    const std::size_t close = open == rest.npos ? rest.npos : rest.find('\'', open + 1);
    if (close == rest.npos) break;
    const std::string_view word = rest.substr(open + 1, close - open - 1);
    line += rest.substr(0, open + 1);
    if (is_path(word, folders)) {
      line += word.substr(word.rfind('/') + 1);
      line += '\'';
      rest.remove_prefix(close + 1);
    } else {
      rest.remove_prefix(open + 1);  // the second quote may be an apostrophe before a path
    }
  }
  line += rest;
  std::ranges::replace(line, '\n', ' ');
  return printable(line);
}

}  // namespace freeplay
