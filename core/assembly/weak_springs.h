// Springs that could not bear by far the weight that rests on them alone.
#pragma once

#include <functional>
#include <string>

#include "system/system.h"

namespace freeplay {

/// `doubtful-value`: of springs that alone hold a mechanism against gravity, through arms and one after the other, the
/// one that would have to give by most of its own length, or in radians, where that is fifty of them. Only where the
/// forces of the springs are determined, all other elements are dampers and nothing else acts. `closed`: with every
/// clearance closed, evaluated at the start; drivers hold what they move.
void doubt_weak_springs(
    const System& closed, const Evaluation& shut,
    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt);

}  // namespace freeplay
