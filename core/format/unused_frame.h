// UnusedFrame: frames that nothing stands on.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Warns `unused` for every declared frame that no joint, driver, force, output or analysis names; one of a template
/// counts as used when it is in any instance. Frames of imported robots are left out. Where two joints hold the body at
/// another of its frames, the warning asks whether one of them is meant here. Warns `same-frame` of a planar link that
/// is pinned at one place only, by several joints.
void warn_unused_frames(const Draft& draft);

}  // namespace freeplay
