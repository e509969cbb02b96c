#include "cli/terminal.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/text.h"

namespace freeplay {
namespace {

int stdout_error = 0;  // errno of the first failure

bool colour_wanted(bool no_color) {
  const char* none = std::getenv("NO_COLOR");
  const char* kind = std::getenv("TERM");
  return !no_color && (none == nullptr || *none == '\0') && kind != nullptr && std::strcmp(kind, "dumb") != 0 &&
         stderr_is_terminal();
}

/// Paints the word that says how bad a message is. Source lines are indented and stay as they are.
void append_painted(std::string& out, std::string_view line) {
  constexpr std::pair<std::string_view, const char*> words[] = {{": error: ", "\x1b[1;31m"},
                                                                {": warning: ", "\x1b[1;35m"}};
  for (const auto& [word, colour] : words) {
    const std::size_t at = line.find(word);
    if (line.starts_with(' ') || at == std::string_view::npos) continue;
    out.append(line.substr(0, at + 2)).append(colour);
    out.append(word.substr(2, word.size() - 3)).append("\x1b[0m").append(line.substr(at + word.size() - 1));
    return;
  }
  out += line;
}

/// Printable but for its line feeds.
std::string printable_lines(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out += printable(text.substr(0, end));
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace

void open_standard_descriptors() {
  int opened = 0;
  while (opened >= 0 && opened <= STDERR_FILENO) opened = ::open("/dev/null", O_RDWR);
  if (opened > STDERR_FILENO) ::close(opened);
}

void print(std::string_view text) { print_data(printable_lines(text)); }

void print_data(std::string_view text) {
  if (stdout_error != 0) return;
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
  stdout_error = errno;
}

std::string stdout_failure() {
  return stdout_error == 0 || stdout_error == EPIPE ? std::string() : std::string(std::strerror(stdout_error));
}

void print_json(const Json& json) { print_data(json_text(json)); }

void print_messages(std::string_view messages, bool no_color) {
  const std::string shown = printable_lines(messages);
  std::string_view text = shown;
  std::string out;
  if (colour_wanted(no_color)) {
    while (!text.empty()) {
      const std::size_t length = std::min(text.find('\n'), text.size() - 1) + 1;
      append_painted(out, text.substr(0, length));
      text.remove_prefix(length);
    }
  } else {
    out = text;
  }
  std::fwrite(out.data(), 1, out.size(), stderr);
}

bool stderr_is_terminal() { return ::isatty(STDERR_FILENO) != 0; }

bool stdout_is_terminal() { return ::isatty(STDOUT_FILENO) != 0; }

int stdout_columns() {
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool stdout_takes_unicode() {
  const char* kind = std::getenv("TERM");
  if (kind != nullptr && std::strcmp(kind, "dumb") == 0) return false;
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    std::string locale = value;
    for (char& c : locale) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return locale.find("utf-8") != std::string::npos || locale.find("utf8") != std::string::npos;
  }
  return false;
}

}  // namespace freeplay
