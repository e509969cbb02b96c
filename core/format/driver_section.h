// The section `drivers`: on one joint, or on several by inverse kinematics.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Adds the drivers of a part; all joints are known.
void add_drivers(Draft& draft, const Part& part);

/// Warns of `elbow` where a driven joint has no use for it. Call when everything is read and right.
void warn_ignored_elbows(const Draft& draft);

}  // namespace freeplay
