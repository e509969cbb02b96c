// BareStart: the start of one run of many, without what is found out about a start besides.
#pragma once

#include <span>

#include "assembly/assembly.h"
#include "assembly/closed_mechanism.h"

namespace freeplay {

/// The same state and actual ranks as by assemble(), and what that throws: no structure, no report and no ranks of the
/// ideal mechanism.
Start assemble_bare(System& system, const OffsetChange& change = {});

/// The same velocities as by solve_velocities(), without the list.
void solve_bare_velocities(ClosedMechanism& mechanism, std::span<const double> mass);

}  // namespace freeplay
