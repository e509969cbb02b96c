// Bodies that start inside each other.
#pragma once

#include "system/state.h"
#include "system/system.h"

namespace freeplay {

/// Throws Error{input} "starts-inside" where surfaces that touch by a contact law, and have no play, stand deeper in
/// each other than half of the smaller radius there. `e`: of the start (term_position, term_velocity).
void refuse_overlap(const System& system, const State& start, const Evaluation& e);

}  // namespace freeplay
