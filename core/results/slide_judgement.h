// Bodies that have slid off each other.
#pragma once

#include "results/summary.h"

namespace freeplay {

/// Adds `out-of-reach` for two moving bodies whose joint lets them slide along each other and that are many sizes of
/// the model apart at the end of the run.
void judge_slides(const RunRecord& record, Verdict& verdict);

}  // namespace freeplay
