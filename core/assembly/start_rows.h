// What the constraint rows at the start of a run say: ranks, paths that can be followed, motions without mass.
#pragma once

#include "assembly/assembly.h"
#include "system/system.h"

namespace freeplay {

/// Of a system evaluated at its start (term_position).
ConstraintFacts constraint_facts(const ConstraintJacobian& jacobian, const ConstraintValues& e);

/// With its frame prescribed the ideal mechanism must be still, and the frame must be able to follow. Throws
/// Error{input} "ik-underdetermined", "ik-unreachable".
void check_paths(const System& closed, const Evaluation& e);

/// Throws Error{input} "singular-mass" when a body can move without moving any mass; says which.
void refuse_massless_motion(const System& system, const Evaluation& e);

}  // namespace freeplay
