// `freeplay validate MODEL...`: checks, assembles and prints the facts.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_validate_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
