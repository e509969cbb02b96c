// Assembly: consistent start of a model: positions, velocities, accelerations, and what the constraints leave free.
#pragma once

#include <functional>

#include "assembly/model_facts.h"
#include "assembly/start_report.h"
#include "assembly/structure.h"
#include "model/model.h"
#include "system/system.h"

namespace freeplay {

/// The start of a run.
struct Start {
  State state;  ///< accepted state at Settings::start, clearance joints released
  ModelFacts facts;
  Structure structure;
  StartReport report{};  ///< start values of the file that were not kept
};

/// Moves the start of a joint with play, given its index and where its second marker would stand in the first.
using OffsetChange = std::function<void(int joint, InitialOffset& offset)>;

/// Finds the start of `model` as model-format section 9 describes and hands the drivers' start values to `system`.
/// Throws Error{input}: "assembly-failed" (names the worst joint and its gap in m or rad), "singular-mass",
/// "ik-unreachable" (names the leg and the time), "ik-underdetermined".
Start assemble(System& system, const OffsetChange& change = {});

}  // namespace freeplay
