// Loading: what the command line says of how models are loaded.
#pragma once

#include "cli/options.h"
#include "load/options.h"

namespace freeplay {

/// Remarks go to stderr, notes only without --quiet.
LoadOptions loading(const CommonOptions& common);

}  // namespace freeplay
