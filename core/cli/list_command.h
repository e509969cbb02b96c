// `freeplay list [KIND]`: the types that a model file may name, or the result columns of a model.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_list_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
