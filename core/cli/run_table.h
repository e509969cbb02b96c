// RunTable: what `freeplay run` prints about a run.
#pragma once

#include <string>

#include "results/summary.h"

namespace freeplay {

/// First line, tables of joints, drivers and paths, residuals.
std::string run_table(const RunRecord& record);

}  // namespace freeplay
