// Plugins: which types a command knows.
#pragma once

#include "cli/options.h"
#include "component/registry.h"
#include "model/document.h"

namespace freeplay {

/// The built-in types and those of plugins: first what the model names (paths from its folder), then `--plugin` (from
/// the present folder), then every library of FREEPLAY_PLUGIN_PATH and of the installation. A library of those folders
/// that is refused is skipped with a warning on stderr; one that was asked for throws Error{plugin}, with its place if
/// a model named it. `document` may be null.
Registry load_registry(const CommonOptions& common, const Document* document);

}  // namespace freeplay
