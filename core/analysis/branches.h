// Branches: all postures that a pose, or a set of inputs, leaves open.
#pragma once

#include "analysis/station.h"

namespace freeplay {

/// All working modes of a pose that gives x, y and angle: 1 and -1 for each two-link leg, in the order of the inputs,
/// 1 first; for other parts what Newton's method finds from many starts. Of other demands (inputs: the assemblies of
/// the direct problem) what it finds for the whole mechanism. What many starts find is all there is only very likely.
/// Those found from starts are sorted by the pose of the frame, then by the angles of the bodies.
std::vector<Posture> all_postures(IdealMechanism& mechanism, const Demand& demand, const Tick& tick = {});

}  // namespace freeplay
