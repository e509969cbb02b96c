// `freeplay describe NAME`: everything that a type's table says.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_describe_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
