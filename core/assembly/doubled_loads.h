// DoubledLoads: forces and torques that are written twice.
#pragma once

#include <functional>
#include <string>

#include "model/model.h"

namespace freeplay {

/// `duplicate-force`: of entries of the types force and torque that act at the same place with the same values.
[[gnu::cold]] void doubt_doubled_loads(
    const Model& model,
    const std::function<void(const char* id, const std::string& message, const AppliedForce&)>& doubt);

}  // namespace freeplay
