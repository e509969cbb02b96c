// Plugins: which types a command knows.
#pragma once

#include "component/registry.h"
#include "format/document.h"
#include "load/options.h"

namespace freeplay {

/// The built-in types and those of plugins: first what the model names (paths from its folder), then those of the
/// options (from the present folder), then every library of FREEPLAY_PLUGIN_PATH and of the installation. A library of
/// those folders that is refused is skipped with a warning; one that was asked for throws Error{plugin}, with its place
/// if a model named it. `document` may be null.
Registry load_registry(const LoadOptions& options, const Document* document);

}  // namespace freeplay
