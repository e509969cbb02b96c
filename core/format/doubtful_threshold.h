// DoubtfulThreshold: numbers without a unit that stand beside an angle or a place that never comes there.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Warns of a number without a unit beside a channel alone, as in `joint.door.angle > 15`, `body.ram.y - 80` and
/// `smooth(joint.door.angle, 20, 30)`: `doubtful-angle` beyond a turn, `doubtful-length` beyond 50 sizes of the model.
void doubt_thresholds(const Draft& draft);

/// `doubtful-angle` for a term of an angle that has no unit, as the number of `45 + 10 deg*sin(...)` or of
/// `20*smooth(...)`: beyond a turn, and round. True after a message.
bool doubt_bare_term(const CheckedValue& written);
/// `doubtful-length` for such a term of a place, 20 times as long as the lengths of the mechanism, `scale` [m].
void doubt_bare_place(const CheckedValue& written, double scale);
/// The number of a term such as `50*smooth(t, 0, 1 s)` of a sum, which goes so far by itself; NaN where there is none.
double bare_swing(std::string_view sum);

}  // namespace freeplay
