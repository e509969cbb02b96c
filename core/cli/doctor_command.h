// `freeplay doctor`: what is installed, found and writable.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_doctor_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
