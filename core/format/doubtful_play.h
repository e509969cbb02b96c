// DoubtfulPlay: clearances that are too wide for the surfaces beside them.
#pragma once

#include "format/parameter_check.h"

namespace freeplay {

/// Warns `doubtful-clearance` at the entry of a joint whose clearance is too wide for its radii or for the lengths of
/// the mechanism, `scale` [m], or narrower than surfaces are rough.
void doubt_play(const CheckedValue& entry, const JointLayout& layout, double scale);

/// The same at the parameters of a block: plays that are longer than everything else of a bearing, gaps that are wide
/// beside the smallest radius or width, and a backlash of teeth that are hardly in mesh (`doubtful-angle`).
void doubt_play_inside(const CheckedParameters& parameters, const JointLayout& layout);

}  // namespace freeplay
