// Bodies that start inside each other.
#pragma once

#include <functional>
#include <string>

#include "system/state.h"
#include "system/system.h"

namespace freeplay {

/// Throws Error{input} "starts-inside" where surfaces that touch by a contact law, and have no play, stand deeper in
/// each other than half of the smaller radius there. `e`: of the start (term_position, term_velocity).
void refuse_overlap(const System& system, const State& start, const Evaluation& e);

/// `starts-inside`: what stands deeper than a hundredth of that radius.
void doubt_overlaps(const System& system, const State& start, const Evaluation& e,
                    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt);

}  // namespace freeplay
