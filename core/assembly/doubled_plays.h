// The same joint with play twice.
#pragma once

#include <functional>
#include <string>

#include "system/system.h"

namespace freeplay {

/// `duplicate-joint`: of joints of one type with play between the same places of the same two bodies, so that each
/// carries a part of the load. `shut`: of the system with every clearance closed.
void doubt_doubled_plays(
    const System& closed, const Evaluation& shut,
    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt);

}  // namespace freeplay
