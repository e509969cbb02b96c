// doubt_idle_axes: axes that change nothing.
#pragma once

#include "load/options.h"
#include "study/file.h"

namespace freeplay {

/// Warns of axes whose values make the same model everywhere, such as a parameter in whose place `set` or --set has put
/// a value, or the play of a joint that is closed: all their points would be one run. The axis of a chain may do so,
/// and a parameter that reducers read.
void doubt_idle_axes(const StudyFile& study, const LoadOptions& options);

}  // namespace freeplay
