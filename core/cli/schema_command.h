// `freeplay schema`: JSON Schemas of what the program reads and writes.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_schema_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
