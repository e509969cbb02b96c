// `freeplay seal DIR...`: makes results of killed runs ordinary ones.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_seal_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
