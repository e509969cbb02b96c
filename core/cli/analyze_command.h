// `freeplay analyze`: kinematics, errors and drive forces of the ideal mechanism.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_analyze_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
