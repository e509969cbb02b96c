#include "cli/init_command.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/shell_word.h"
#include "cli/loading.h"
#include "cli/starter_files.h"
#include "cli/terminal.h"
#include "component/library.h"
#include "contract/component_entry.h"
#include "load/plugins.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

struct InitOptions {
  std::string name, kind = "model", type, from;
};

/// What was written, and the commands to type next.
struct Written {
  std::vector<std::string> files, next;
};

// Names of targets that CMake keeps for itself.
const std::vector<std::string> cmake_words{"all", "clean", "help", "install", "package", "test"};

[[noreturn]] void cannot_write(const fs::path& file, const std::string& why) {
  throw Error(Error::Category::file, "cannot-write", fmt::format("cannot write '{}': {}", file.string(), why));
}

void write_new(const fs::path& file, const std::string& text) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error) cannot_write(file, error.message());
  std::FILE* out = std::fopen(file.c_str(), "wx");  // x: only if it is not there
  if (out == nullptr) cannot_write(file, errno == EEXIST ? "it is there already" : std::strerror(errno));
  const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
  if (std::fclose(out) != 0 || !written) cannot_write(file, std::strerror(errno));
}

/// The word that starts this program from a shell.
std::string program_word() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const char* list = std::getenv("PATH");
  for (std::string_view rest = list ? list : ""; !rest.empty();) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path found = fs::path(rest.substr(0, end)) / "freeplay";
    if (fs::exists(found, error)) return fs::equivalent(found, program, error) ? "freeplay" : program.string();
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return program.string();
}

Written init_model(const InitOptions& options) {
  const std::string name = options.name.empty() ? options.from : options.name;
  fs::path file = name;
  if (file.extension() != ".yaml" && file.extension() != ".yml") file += ".yaml";
  write_new(file, starter_model(options.from, file.stem().string()));
  return {{file.string()}, {program_word() + " run " + shell_word(file.string())}};
}

/// Lower-case words of letters and digits, joined by '-' or '_', that begin with a letter.
bool is_plugin_name(const std::string& name) {
  char before = '-';
  for (const char c : name) {
    const bool letter = c >= 'a' && c <= 'z', digit = c >= '0' && c <= '9', joint = c == '-' || c == '_';
    if (!letter && !digit && !joint) return false;
    if ((before == '-' || before == '_') && joint) return false;
    before = c;
  }
  return !name.empty() && name.front() >= 'a' && name.front() <= 'z' && before != '-' && before != '_';
}

void check_plugin_name(const std::string& name, ComponentKind kind, const Registry& registry) {
  if (!is_plugin_name(name)) {
    throw Error(Error::Category::usage, "bad-value", fmt::format("bad name '{}' of a plugin", name), {},
                "lower-case words of letters and digits joined by '-', such as my-joint");
  }
  if (std::ranges::find(cmake_words, name) != cmake_words.end()) {
    throw Error(Error::Category::usage, "bad-value", fmt::format("CMake keeps the name '{}' for itself", name));
  }
  for (const Json& entry : core_entries()) {
    if (entry["name"] != name || kind != ComponentKind::joint) continue;
    throw Error(Error::Category::usage, "bad-value", fmt::format("the model file has a meaning for '{}'", name));
  }
  for (const RegisteredComponent& entry : registry.components()) {
    if (entry.component->kind != kind || entry.component->description.name != name) continue;
    throw Error(
        Error::Category::usage, "bad-value",
        fmt::format("'{}' ({}) has a type '{}' already", entry.library, entry.component->description.summary, name));
  }
}

/// Where CMake has to look for the package of this program; empty if it looks there by itself.
fs::path package_prefix() {
  const fs::path program = program_folder();
  std::error_code error;
  for (const fs::path& prefix : {program, program.parent_path()}) {
    for (const char* folder : {"lib", "lib64", "share"}) {
      if (!fs::exists(prefix / folder / "cmake/Freeplay/FreeplayConfig.cmake", error)) continue;
      return prefix == "/usr" || prefix == "/usr/local" ? fs::path() : prefix;
    }
  }
  return {};
}

Written init_plugin(const InitOptions& options, const CommonOptions& common) {
  const fs::path folder = options.name.empty() ? "my-" + options.type : options.name;
  std::string name = folder.filename().string();
  const ComponentKind kinds[] = {ComponentKind::joint, ComponentKind::contact_law, ComponentKind::friction_law,
                                 ComponentKind::integrator};
  const std::vector<std::string> words{"joint", "contact", "friction", "integrator"};
  const auto kind = kinds[std::ranges::find(words, options.type) - words.begin()];
  check_plugin_name(name, kind, load_registry(loading(common), nullptr));
  std::ranges::replace(name, '_', '-');
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error)) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error))) {
    cannot_write(folder, "it is there already");
  }
  Written written;
  for (const StarterFile& file : starter_plugin(options.type, name, folder, package_prefix())) {
    write_new(file.path, file.text);
    written.files.push_back(file.path.string());
  }
  const std::string source = shell_word(folder.string()), build = shell_word((folder / "build").string());
  const std::string program = program_word();
  written.next = {
      fmt::format("cmake -S {} -B {}", source, build), fmt::format("cmake --build {}", build),
      fmt::format("{} check-plugin {}", program, shell_word((folder / "build" / (snake_case(name) + ".so")).string())),
      fmt::format("{} run {} --allow-plugins", program, shell_word((folder / "example.yaml").string()))};
  return written;
}

int list_starters(const CommonOptions& common) {
  const std::vector<std::string> names = starter_models();
  if (common.json) {
    print_json(names);
  } else {
    print(fmt::format("{}\n", fmt::join(names, "\n")));
  }
  return 0;
}

int init(InitOptions options, const CommonOptions& common) {
  require_word("kind", options.kind, {"model", "plugin"});
  const bool plugin = options.kind == "plugin";
  if (plugin && options.type.empty()) {
    throw Error(Error::Category::usage, "missing-argument", "a plugin needs --type", {},
                fmt::format("one of {}", fmt::join(starter_types(), ", ")));
  }
  if (!plugin && !options.type.empty()) {
    throw Error(Error::Category::usage, "unexpected-argument", "--type is for --kind plugin");
  }
  if (plugin && !options.from.empty()) {
    throw Error(Error::Category::usage, "unexpected-argument", "--from is for --kind model");
  }
  if (options.from == "list" && !options.name.empty()) {
    throw Error(Error::Category::usage, "unexpected-argument",
                fmt::format("--from list writes nothing, so '{}' is not needed", options.name));
  }
  if (options.from.empty()) options.from = "four-bar";
  if (plugin) {
    require_word("type", options.type, starter_types());
  } else if (options.from == "list") {
    return list_starters(common);
  } else {
    require_word("starter", options.from, starter_models());
  }
  const Written written = plugin ? init_plugin(options, common) : init_model(options);
  if (common.json) {
    print_json(Json{{"files", written.files}, {"next", written.next}});
  } else if (!common.quiet) {
    print(fmt::format("wrote {}\nnext:\n  {}\n", fmt::join(written.files, ", "), fmt::join(written.next, "\n  ")));
  }
  return 0;
}

}  // namespace

Command add_init_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "init", "Write a model or a plugin project to start from");
  const auto options = std::make_shared<InitOptions>();
  add_option(*app, "NAME", options->name, "Model file or folder to write");
  add_option(*app, "--kind", options->kind, "model (the default) or plugin", "KIND");
  add_option(*app, "--type", options->type, "Of a plugin: joint, contact, friction or integrator", "TYPE");
  add_option(*app, "--from", options->from, "Of a model: the mechanism to copy (four-bar); `--from list` names them",
             "MECHANISM");
  add_common_options(*app, common);
  return {app, [options, &common] { return init(*options, common); }};
}

}  // namespace freeplay
