// Judgement: the criteria of docs/trust.md that need no more than what a run has recorded.
#pragma once

#include "results/summary.h"

namespace freeplay {

/// Adds a reason for each criterion that the run does not meet.
void judge(const RunRecord& record, Verdict& verdict);

}  // namespace freeplay
