// LoadJudgement: loads, springs, motors and speeds that no machine of this mass has.
#pragma once

#include "results/summary.h"

namespace freeplay {

/// Adds `load-size` for the largest load against the masses that it would have to move, `body-speed` for the fastest
/// body of a mechanism on ground.
void judge_loads(const RunRecord& record, Verdict& verdict);

}  // namespace freeplay
