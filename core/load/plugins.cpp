#include "load/plugins.h"

#include <algorithm>
#include <filesystem>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "base/kept_input.h"
#include "base/sha256.h"
#include "component/library.h"
#include "format/gear.h"
#include "format/model_builder.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

/// A joint type with play needs its ideal twin, of whatever library. Judged when all libraries are there: an error for
/// those that were asked for (the first `named`), a warning for those that only lie in the folders for plugins.
void require_twins(const Registry& registry, std::size_t named, const LoadOptions& options) {
  for (const RegisteredComponent& type : registry.components()) {
    const Description& description = type.component->description;
    if (type.component->kind != ComponentKind::joint || description.ideal == nullptr) continue;
    if (std::string_view(description.ideal) == gear_word) continue;  // of the format itself
    if (registry.find(ComponentKind::joint, description.ideal) != nullptr) continue;
    const std::string reason = fmt::format("plugin '{}': the ideal type '{}' of its joint '{}' is not there",
                                           type.library, description.ideal, description.name);
    const auto libraries = std::span(registry.libraries()).first(named);
    if (std::ranges::find(libraries, type.library, &RegisteredLibrary::path) != libraries.end()) {
      throw Error(Error::Category::plugin, "plugin-refused", reason);
    }
    if (options.warn) options.warn(reason);
  }
}

fs::path name_of(const std::string& file) { return fs::path(file).filename(); }

bool lies_in_plugin_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  return std::ranges::any_of(plugin_folders(), [&](const fs::path& one) {
    std::error_code ignored;
    return fs::equivalent(one, folder, ignored);
  });
}

/// Files of that name in the folders for plugins.
std::vector<std::string> installed(const std::string& word) {
  std::vector<std::string> files;
  for (const fs::path& folder : plugin_folders()) {
    std::error_code ignored;
    const fs::path file = folder / name_of(word);
    if (fs::is_regular_file(file, ignored)) files.push_back(file.string());
  }
  return files;
}

/// The libraries of one command, in the order in which they are looked for.
class Loader {
 public:
  explicit Loader(const LoadOptions& options) : options_(options) {}

  void load_named(const Document& document) {
    for (const NamedPlugin& plugin : named_plugins(document)) {
      try {
        load_named(plugin.word, document.file_name());
      } catch (const Error& error) {
        throw Error(error.category(), error.id(), error.message(), plugin.location, error.hint());
      }
    }
  }

  void load_options() {
    for (const std::string& word : options_.plugins) {
      try {
        load_plugin(registry, find_plugin(word, {}));
      } catch (const Error& error) {
        // A report on a model names its file, which does not name the plugin.
        throw Error(error.category(), error.id(), fmt::format("--plugin {}: {}", word, error.message()), {},
                    error.hint());
      }
    }
  }

  void load_recorded() {
    for (const std::string& file : options_.recorded_plugins) {
      const auto same_name = [&](const RegisteredLibrary& library) { return name_of(library.path) == name_of(file); };
      if (std::ranges::any_of(registry.libraries(), same_name)) continue;
      const fs::path found = find_plugin(file, {});
      require_plugin_allowed(found, options_);
      load_plugin(registry, found);
    }
  }

  /// Those that a model names, and those of options of then. What is installed is loaded from there.
  void load_copies(const Document& document) {
    for (const std::string& file : kept_libraries(document.file_name())) {
      if (stands_in_options(file) || !installed(file).empty()) continue;
      require_plugin_allowed(file, options_);
      load_plugin(registry, file);
    }
  }

  Registry registry = Registry::with_builtins();

 private:
  bool stands_in_options(const std::string& file) const {
    return std::ranges::any_of(options_.plugins,
                               [&](const std::string& other) { return name_of(other) == name_of(file); });
  }

  void load_named(const std::string& word, const std::string& model_file) {
    fs::path file;
    const auto same_name = [&](const std::string& other) { return name_of(other) == name_of(word); };
    const bool option_stands_for_it = stands_in_options(word);
    if (std::ranges::any_of(kept_libraries(model_file), same_name)) return;  // load_copies() takes it
    try {
      file = find_plugin(word, fs::path(model_file).parent_path());
      if (option_stands_for_it && lies_in_plugin_folder(file)) return;
    } catch (const Error&) {
      if (option_stands_for_it) return;
      // A copy of a model names paths from where the model was.
      const auto kept = is_kept_copy(model_file) ? installed(word) : kept_plugins(model_file);
      const auto there = std::ranges::find_if(kept, same_name);
      std::error_code ignored;
      if (there == kept.end() || !fs::is_regular_file(*there, ignored)) throw;
      file = *there;
    }
    require_plugin_allowed(file, options_);
    load_plugin(registry, file);
  }

  const LoadOptions& options_;
};

bool is_option(const fs::path& file, const LoadOptions& options) {
  return std::ranges::any_of(options.plugins, [&](const std::string& word) {
    std::error_code ignored;
    try {
      return fs::equivalent(find_plugin(word, {}), file, ignored);
    } catch (const Error&) {
      return false;  // reported when it is loaded
    }
  });
}

}  // namespace

void require_plugin_allowed(const fs::path& file, const LoadOptions& options) {
  if (options.allow_plugins || lies_in_plugin_folder(file) || is_option(file, options)) return;
  throw Error(Error::Category::plugin, "plugin-not-allowed",
              fmt::format("the plugin '{}' (SHA-256 {}) lies outside of the folders for plugins, and to load it is to "
                          "run its code",
                          file.string(), sha256_of_file(file.string())),
              {}, fmt::format("if you trust it, add --allow-plugins, or --plugin {}", file.string()));
}

std::vector<std::string> own_plugins(const Registry& registry) {
  std::vector<std::string> files;
  for (const RegisteredLibrary& library : registry.libraries()) {
    if (library.path != "built-in" && !lies_in_plugin_folder(library.path)) files.push_back(library.path);
  }
  return files;
}

Registry load_registry(const LoadOptions& options, const Document* document) {
  Loader loader(options);
  if (document != nullptr) {
    loader.load_named(*document);
    loader.load_copies(*document);
  }
  loader.load_options();
  loader.load_recorded();
  Registry& registry = loader.registry;
  const std::size_t named = registry.libraries().size();
  for (const std::string& reason : load_plugin_folders(registry)) {
    if (options.warn) options.warn(reason);
  }
  require_twins(registry, named, options);
  return std::move(registry);
}

}  // namespace freeplay
