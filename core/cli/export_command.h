// `freeplay export RESULT`: rows or events of a result as another file.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_export_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
