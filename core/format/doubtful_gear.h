// DoubtfulGear: ratios of gears that look like those of another unit.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Warns `doubtful-length` for a gear of a slide whose pitch radius or lead is far beyond the lengths of the mechanism,
/// or on which a prescribed motion moves a slide so far; `doubtful-speed` where one becomes too fast through a gear
/// that says no unit, or faster than any machine; `doubtful-value` for one stage that makes a
/// motion more than a hundred times as fast, and by that faster than motors turn, or turns of what swings.
void doubt_gears(const Draft& draft);

}  // namespace freeplay
