// SingularJudgement: forces beside a singular position of the constraints.
#pragma once

#include "results/summary.h"

namespace freeplay {

/// Adds `singular-position` where they say nothing.
[[gnu::cold]] void judge_singular(const RunRecord& record, Verdict& verdict);

}  // namespace freeplay
