// DoubtfulRest: motions, motors and loads that wait for a time that the run does not come to.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Warns `doubtful-time` for a driver, a path, a force or a parameter of a joint or of an entry of `forces` whose
/// formula or table depends on time and does not change before the end of the run, as `smooth(t, 200, 2200)` in a run
/// of 3 s: where no unit of time stands in the formula, or where a load, or what makes one, is zero all the time. Runs
/// whose end the command line gives are left alone.
void doubt_rests(const Draft& draft);

}  // namespace freeplay
