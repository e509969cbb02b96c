#include "fuzz/harness.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/text.h"
#include "convert/complete_model.h"
#include "format/model_builder.h"
#include "load/model_file.h"
#include "yaml/document.h"

namespace freeplay::fuzz {
namespace {

/// Lines end with LF, CR LF or, as YAML and tables have it and XML readers do not agree on, with a lone CR.
std::vector<std::string_view> lines_of(std::string_view text, bool lone_returns) {
  std::vector<std::string_view> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(lone_returns ? "\r\n" : "\n", begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
  }
  return lines;
}

bool has_place(const std::vector<std::string_view>& lines, const Location& place) {
  const auto line = static_cast<std::size_t>(place.line);
  return place.line > 0 && line <= lines.size() && place.column >= 1 &&
         place.column <= character_count(lines[line - 1]) + 1;
}

bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c == '\n' || static_cast<unsigned char>(c) >= 0x20; });
}

/// What a model with a robot is converted to must be YAML again.
void check_conversion(const Document& document) {
  std::vector<std::string> renamed;
  const std::string text = complete_model_text(document, renamed);
  Diagnostics diagnostics;
  const bool read = parse_yaml(text, "converted.yaml", diagnostics).has_value();
  if (!read || diagnostics.has_errors()) std::fputs((text + diagnostics.format(5)).c_str(), stderr);
  require(read && !diagnostics.has_errors(), "a converted model can be read");
}

}  // namespace

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

const Registry& builtin_types() {
  static const Registry registry = Registry::with_builtins();
  return registry;
}

MemoryFile::MemoryFile() : descriptor_(memfd_create("input", 0)), path_(fmt::format("/proc/self/fd/{}", descriptor_)) {
  require(descriptor_ >= 0, "a file in memory can be made");
}

void MemoryFile::write(std::string_view text) const {
  require(ftruncate(descriptor_, 0) == 0, "the file in memory can be emptied");
  const auto written = pwrite(descriptor_, text.data(), text.size(), 0);
  require(written == static_cast<ssize_t>(text.size()), "the file in memory can be written");
}

void check_messages(const Diagnostics& diagnostics, const std::string& file_name, std::string_view text) {
  require(is_printable(diagnostics.format(0)), "messages hold no control characters");
  const std::vector<std::string_view> lines = lines_of(text, true), longer = lines_of(text, false);
  for (const Diagnostic& message : diagnostics.sorted()) {
    require(!message.id.empty() && !message.message.empty(), "a message has an id and a text");
    if (message.location.file != file_name || message.location.line == 0) continue;
    const bool inside = has_place(lines, message.location) || has_place(longer, message.location);
    if (!inside) std::fputs(diagnostics.format(0).c_str(), stderr);
    require(inside, "a message points to a character of the file");
  }
}

void check_model(std::string text, const std::string& file_name) {
  Diagnostics diagnostics;
  std::unique_ptr<Model> model;
  std::optional<Document> document;
  bool thrown = false;
  try {
    document = parse_model(text, file_name, diagnostics);
    if (document) model = build_model(*document, builtin_types(), {}, diagnostics);
  } catch (const Error& error) {
    require(error.category() != Error::Category::internal, "no input is an internal error");
    thrown = true;
  }
  require(thrown || (model != nullptr) != diagnostics.has_errors(), "there is a model or an error");
  check_messages(diagnostics, file_name, text);
  if (model && !document->attachments().empty()) check_conversion(*document);
}

void check_robot(const std::string& text, const std::string& file_name) {
  static const MemoryFile file;
  check_model(text, file_name);
  file.write(text);
  // Every third input takes each way, so that all stay fast and the same input takes the same way again.
  constexpr const char* ways[] = {"plane: xz, loops: two-parents", "plane: yz, repair: inertia, base: floating",
                                  "merge_fixed: true, loops: two-parents, repair: inertia, limits: stop"};
  std::size_t sum = 0;
  for (const char c : text) sum += static_cast<unsigned char>(c);
  check_model(fmt::format("freeplay: 1\nurdf: {{file: {}, {}}}\n", file.path(), ways[sum % 3]), "sidecar.yaml");
}

}  // namespace freeplay::fuzz
