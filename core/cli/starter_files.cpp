#include "cli/starter_files.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "base/error.h"
#include "cli/embedded_files.h"

namespace freeplay {
namespace {

constexpr std::string_view model_folder = "mechanisms/", plugin_folder = "plugins/template/";

std::string embedded(const std::string& path) {
  for (const EmbeddedFile& file : embedded_files()) {
    if (file.path == path) return std::string(file.text);
  }
  throw Error(Error::Category::internal, "internal", "the program carries no file '" + path + "'");
}

/// Names of the carried files below `folder` that end in `suffix`, without both.
std::vector<std::string> names_of(std::string_view folder, std::string_view suffix) {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embedded_files()) {
    std::string_view path = file.path;
    if (!path.starts_with(folder) || !path.ends_with(suffix)) continue;
    path.remove_prefix(folder.size());
    path.remove_suffix(suffix.size());
    names.emplace_back(path);
  }
  return names;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// The template's names replaced by those of the new type.
std::string renamed(const std::string& text, const std::string& name) {
  return replaced(replaced(replaced(text, "my-type", name), "my_type", snake_case(name)), "MyType",
                  camel_case(name) + "Type");
}

}  // namespace

std::string snake_case(const std::string& kebab) {
  std::string name = kebab;
  std::ranges::replace(name, '-', '_');
  return name;
}

std::string camel_case(const std::string& kebab) {
  std::string name;
  bool begins = true;
  for (const char c : kebab) {
    if (c != '-') name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '-';
  }
  return name;
}

std::vector<std::string> starter_models() { return names_of(model_folder, ".yaml"); }
std::vector<std::string> starter_types() { return names_of(plugin_folder, ".cpp"); }

std::string starter_model(const std::string& from, const std::string& name) {
  // A name may be anything that stands in quotes.
  std::string quoted = "'";
  for (const char c : name) quoted += c == '\'' ? "''" : std::string(1, c);
  const bool plain = std::ranges::all_of(name, [](unsigned char c) { return std::isalpha(c) || c == '-' || c == '_'; });
  const std::string line = "name: " + (plain ? name : quoted + "'");
  std::string text = embedded(std::string(model_folder) + from + ".yaml");
  const std::size_t at = text.find("\nname:");
  if (at == std::string::npos) return text;
  return text.replace(at + 1, text.find('\n', at + 1) - at - 1, line);
}

std::vector<StarterFile> starter_plugin(const std::string& type, const std::string& name,
                                        const std::filesystem::path& folder, const std::filesystem::path& prefix) {
  const std::string base(plugin_folder);
  std::string build = renamed(embedded(base + "CMakeLists.txt"), name);
  if (!prefix.empty()) {
    build = replaced(build, "find_package(Freeplay REQUIRED)",
                     "find_package(Freeplay REQUIRED HINTS [=[" + prefix.string() + "]=])");
  }
  return {{folder / "CMakeLists.txt", build},
          {folder / (snake_case(name) + ".cpp"), renamed(embedded(base + type + ".cpp"), name)},
          {folder / "example.yaml", renamed(embedded(base + type + ".yaml"), name)}};
}

}  // namespace freeplay
