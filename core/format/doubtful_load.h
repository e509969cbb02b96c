// DoubtfulLoad: forces, torques and motors that no machine of this mass has.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Warns `doubtful-value` for an entry of `forces` or a driver by force or torque that gives all masses together more
/// than most_of_load, be its unit written or not; of what changes with time some instants are looked at.
void doubt_loads(const Draft& draft);

}  // namespace freeplay
