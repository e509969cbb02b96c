// Surfaces that were to touch and never did.
#pragma once

#include "results/summary.h"

namespace freeplay {

/// Adds `never-touches` for a joint that may lift off whose surfaces were apart from the start of a completed run to
/// its end.
void judge_touch(const RunRecord& record, Verdict& verdict);

}  // namespace freeplay
