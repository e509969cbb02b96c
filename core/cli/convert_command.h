// `freeplay convert IN OUT`: URDF to YAML and back.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_convert_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
