// study: many runs from one file.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_study_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
