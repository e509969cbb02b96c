// `freeplay plot`: channels of a result as a picture.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_plot_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
