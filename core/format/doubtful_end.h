// DoubtfulEnd: a run that goes on for thousands of turns, as one whose end is in milliseconds.
#pragma once

#include "format/checked_value.h"
#include "format/draft.h"

namespace freeplay {

/// Warns `doubtful-time` for the `end` of a section `simulation` without a unit up to which a run takes more than 1e7
/// steps of one size, more than a million of them and a thousand turns or swings of its slowest driver, or under an
/// accuracy three thousand; and for any with more than 1e9 steps. Runs whose end or step the command line gives are
/// left alone.
void doubt_end(const Draft& draft, const CheckedValue& simulation);

}  // namespace freeplay
