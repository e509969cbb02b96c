// Postures from which analyses begin.
#pragma once

#include "analysis/posture.h"

namespace freeplay {

/// The start, its legs bent as Platform::elbow says if it was given; where a leg is stretched or folded there, so that
/// the `given` components of the pose cannot lead the mechanism away from it, a posture nearby: inputs turned, or
/// pushed, a little to the side of Platform::elbow.
Posture regular_start(IdealMechanism& mechanism, const Components& given);

/// Closes the joints of a posture that is nearly right. Throws Error{input} "assembly-failed".
void close_joints(const IdealMechanism& mechanism, double t, Posture& posture);

}  // namespace freeplay
