// Plugins: which types a command knows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "component/registry.h"
#include "format/document.h"
#include "load/options.h"

namespace freeplay {

/// The built-in types and those of plugins: first what the model names (paths from its folder), then those of the
/// options (from the present folder), then every library of FREEPLAY_PLUGIN_PATH and of the installation. A library of
/// those folders that is refused is skipped with a warning; one that was asked for throws Error{plugin}, with its place
/// if a model named it. A model that stands in a result finds what its run was made with; the copy of one in the folder
/// of a study is made with the libraries beside it, unless an option names one of that file name. `document` may be
/// null.
Registry load_registry(const LoadOptions& options, const Document* document);

/// Files of the libraries of a registry that lie in none of the folders for plugins: who takes a model elsewhere takes
/// them along.
std::vector<std::string> own_plugins(const Registry& registry);

/// A model or a result from elsewhere runs no code: throws Error{plugin} "plugin-not-allowed" for a library that lies
/// in none of the folders for plugins, unless an option names it or allows all. Nothing of it has been loaded then.
void require_plugin_allowed(const std::filesystem::path& file, const LoadOptions& options);

}  // namespace freeplay
