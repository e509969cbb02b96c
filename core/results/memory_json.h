// What joints remember at the end of a run, for the summary.
#pragma once

#include <vector>

#include "base/json_text.h"
#include "run/simulation.h"

namespace freeplay {

/// Internal variables and history of all joints and force elements that have some, by their names; `memory` is by
/// joint.
Json memory_json(const Model& model, const std::vector<JointMemory>& memory);

}  // namespace freeplay
