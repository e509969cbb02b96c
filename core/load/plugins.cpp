#include "load/plugins.h"

#include <algorithm>
#include <filesystem>
#include <span>

#include <fmt/format.h>

#include "component/library.h"
#include "format/model_builder.h"

namespace freeplay {
namespace {

/// A joint type with play needs its ideal twin, of whatever library. Judged when all libraries are there: an error for
/// those that were asked for (the first `named`), a warning for those that only lie in the folders for plugins.
void require_twins(const Registry& registry, std::size_t named, const LoadOptions& options) {
  for (const RegisteredComponent& type : registry.components()) {
    const Description& description = type.component->description;
    if (type.component->kind != ComponentKind::joint || description.ideal == nullptr) continue;
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

}  // namespace

Registry load_registry(const LoadOptions& options, const Document* document) {
  Registry registry = Registry::with_builtins();
  if (document != nullptr) {
    const std::filesystem::path folder = std::filesystem::path(document->file_name()).parent_path();
    for (const NamedPlugin& plugin : named_plugins(*document)) {
      try {
        load_plugin(registry, find_plugin(plugin.word, folder));
      } catch (const Error& error) {
        throw Error(error.category(), error.id(), error.message(), plugin.location, error.hint());
      }
    }
  }
  for (const std::string& word : options.plugins) {
    try {
      load_plugin(registry, find_plugin(word, {}));
    } catch (const Error& error) {
      // A report on a model names its file, which does not name the plugin.
      throw Error(error.category(), error.id(), fmt::format("--plugin {}: {}", word, error.message()), {},
                  error.hint());
    }
  }
  const std::size_t named = registry.libraries().size();
  for (const std::string& reason : load_plugin_folders(registry)) {
    if (options.warn) options.warn(reason);
  }
  require_twins(registry, named, options);
  return registry;
}

}  // namespace freeplay
