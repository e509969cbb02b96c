// `freeplay reproduce RESULT`: makes a thing again from its record, and compares.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_reproduce_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
