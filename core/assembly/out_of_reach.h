// Why and when drivers ask for positions that the ideal mechanism cannot take.
#pragma once

#include <optional>
#include <string>

#include "system/state.h"
#include "system/system.h"

namespace freeplay {

/// Why a run that ended at time `t` could not go on, where a driver asks for a position that the ideal mechanism cannot
/// take: which joint, where, how far the loop then is from closing, and between which values it can be driven, or what
/// holds it where it can be driven nowhere. It ends with its word: "[dead-point]" or "[locked]". Empty where the
/// mechanism could follow. `start` is the state in which the run of `system` began.
std::optional<std::string> why_out_of_reach(const System& system, const State& start, double t);

/// The first time at which a driver asks for a position that the mechanism could not take though all its play were
/// added up twice: from there on contacts are torn apart. Infinite where there is none, and where several drivers move.
double out_of_reach_from(const System& system, const State& start);

}  // namespace freeplay
