// LockedGuide: a guide that closes a loop in which nothing can move.
#pragma once

#include "assembly/structure.h"
#include "system/state.h"

namespace freeplay {

/// Adds `locked` for a guide in a loop of guides and pins of which no motion of the ideal mechanism moves any, with its
/// drivers let go, where something drives the mechanism or a start speed is given. Pins alone may be a truss. `start`
/// is a state of `system`; where something moves it is looked at in a second position, too, as a guide in dead centre
/// stands still for an instant.
void doubt_guides(const System& system, const State& start, Structure& structure);

}  // namespace freeplay
