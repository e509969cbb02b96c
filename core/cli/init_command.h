// `freeplay init`: writes a model, or a plugin project, to start from.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_init_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
