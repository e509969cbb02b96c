// `freeplay report RESULT...`: results as one HTML page.
#pragma once

#include "cli/options.h"

namespace freeplay {

Command add_report_command(CLI::App& program, CommonOptions& common);

}  // namespace freeplay
