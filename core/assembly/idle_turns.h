// Links in space that turn where all their joints are.
#pragma once

#include <functional>
#include <string>

#include "system/system.h"

namespace freeplay {

/// `same-frame`: of links that joints hold at one and the same place alone, away from the centre of mass, if a turn
/// about that place moves nothing else, as of a crank between a pin and a ball at its tip. What gears or forces take
/// hold of may be meant to, and so may links of robots. `locked`: of a driver that only spins a link about a line
/// through all of its joints, as of a crank about its own length. Of planar models the reader of the file says the
/// same, before they are assembled. `shut`: of the system with every clearance closed.
void doubt_idle_turns(
    const System& closed, const Evaluation& shut,
    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt);

}  // namespace freeplay
