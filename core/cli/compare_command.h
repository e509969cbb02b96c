// `freeplay compare A B`: how far two results agree.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_compare_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
