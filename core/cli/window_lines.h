// What the tables of a run are about: which part of it, and what they leave out.
#pragma once

#include <string>

#include "results/summary.h"

namespace freeplay {

/// "  statistics from 0.1 s to 0.6 s", larger peaks before that, and peaks that the written rows do not show; each line
/// with its end.
std::string window_lines(const RunRecord& record);

}  // namespace freeplay
