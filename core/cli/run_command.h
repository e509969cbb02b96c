// `freeplay run MODEL`: simulates a model and writes its results.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_run_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
