// IdleElements: entries of `forces` that the joints beside them let do nothing, dampers that stop a body at once, stops
// that it has passed, springs that are wound by a turn, and strands against gears.
#pragma once

#include "assembly/structure.h"

namespace freeplay {

/// Adds `idle-force` for an element along or about an axis, along or about which a joint between the same two bodies,
/// closed, lets them not move, or whose two ends an ideal one holds at one place; and `doubtful-value` for a damping
/// that stops what it works on, through joints and drivers, faster than sound crosses it, and for a stop that starts
/// beyond an end by a tenth of its way, or beyond which a driver of the same bodies moves by a fiftieth;
/// `doubtful-angle` for a torsion spring that starts wound by a whole turn, more or less by an eighth of it, and
/// `doubtful-value` for strands round wheels that joints let turn by another ratio. `system` stands at the start,
/// `at_start` has its positions and coordinates; `closed` has all clearances closed, `shut` is evaluated at the same
/// positions.
void doubt_elements(const System& system, const Evaluation& at_start, const System& closed, const Evaluation& shut,
                    Structure& structure);

}  // namespace freeplay
