// `freeplay check-plugin LIB`: whether the types of a plugin keep their contracts.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_check_plugin_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
