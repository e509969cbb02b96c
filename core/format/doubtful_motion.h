// DoubtfulMotion: prescribed motions that look like those of another unit.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Warns `doubtful-angle` for a driven angle that begins, swings or ends beyond a turn by a number without a unit, and
/// does not grow on and on as `10*t` does; `doubtful-speed` for rates beyond bare_limit::angular_speed without a unit;
/// `doubtful-length` for a driven position that swings or ends beyond bare_limit::length of the lengths around it;
/// `doubtful-time` where a fixed step turns a driven joint by more than half a radian, or a table goes on far beyond
/// the run.
void doubt_motions(const Draft& draft);

}  // namespace freeplay
