// PathJudgement: frames that miss the path on which drivers are to lead them.
#pragma once

#include "results/summary.h"

namespace freeplay {

/// Adds `path-missed` where a frame is farther from its path than play and elastic elements explain.
void judge_paths(const RunRecord& record, Verdict& verdict);

}  // namespace freeplay
