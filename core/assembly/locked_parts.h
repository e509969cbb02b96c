// LockedParts: what cannot move in a mechanism that can.
#pragma once

#include "assembly/structure.h"
#include "system/state.h"

namespace freeplay {

/// Adds `locked`, where something drives the mechanism or a start speed is given and its drivers are let go:
/// for a guide in a loop of guides and pins of which no motion of the ideal mechanism moves any; and for bodies that no
/// motion moves though no joint holds all of their freedoms, where one of them has not kept the pose that the file
/// gives, hangs on a joint with play or on the pivot of a body that moves: pins alone may be a truss. `start` is a
/// state of `system`; where something moves it is looked at in further positions, too, as a guide in dead centre stands
/// still for an instant, and what follows a cam for as long as it dwells.
void doubt_locked(const System& system, const State& start, Structure& structure);

}  // namespace freeplay
