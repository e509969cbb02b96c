// ForceDoubts: springs and other entries of `forces` that do something else than is meant, or nothing.
#pragma once

#include <functional>

#include "assembly/structure.h"

namespace freeplay {

/// `doubtful-length`: a spring far from its free length at the start, or without a length, where it has no direction.
/// `duplicate-force`: the same twice between the same frames. `unused`: without a number that makes a force.
/// `doubtful-value`: springs that a body's weight stretches by many times the size of the model. Positions are those of
/// `at_start`.
void doubt_forces(const System& system, const Evaluation& at_start,
                  const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt);

}  // namespace freeplay
