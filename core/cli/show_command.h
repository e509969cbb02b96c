// `freeplay show MODEL`: the model after everything in it is expanded, as text, JSON, graph or drawing.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_show_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
