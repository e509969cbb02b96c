#include "cli/plugins.h"

#include <filesystem>

#include "cli/terminal.h"
#include "component/library.h"
#include "model/model_builder.h"

namespace freeplay {

Registry load_registry(const CommonOptions& common, const Document* document) {
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
  for (const std::string& word : common.plugins) load_plugin(registry, find_plugin(word, {}));
  for (const std::string& reason : load_plugin_folders(registry)) {
    print_messages("freeplay: warning: " + reason + "\n", common.no_color);
  }
  return registry;
}

}  // namespace freeplay
