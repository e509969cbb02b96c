// DoubtfulRest: motions, motors and loads that wait for a time that the run does not come to.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Warns `doubtful-time` for a formula of a driver or of an entry of `forces` that depends on time, has no unit in its
/// text, and changes neither in the run nor in one ten times as long, as `smooth(t, 200, 2200)` in a run of 3 s.
/// Runs whose end the command line gives are left alone.
void doubt_rests(const Draft& draft);

}  // namespace freeplay
