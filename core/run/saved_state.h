// RunState: a run at the end of an accepted step, as plain numbers.
#pragma once

#include <cstdint>

#include "base/archive.h"

namespace freeplay {

/// Everything that the rest of a run depends on and that does not follow from its model and its start: the state of
/// the mechanism, what integrator, step control and solvers keep from step to step, the account of energy, statistics
/// and counts (docs/architecture.md, "What a state is"). A run that goes on from it ends bit for bit where the one ends
/// that it was saved in.
struct RunState {
  double time = 0.0;       ///< [s]
  std::int64_t steps = 0;  ///< accepted so far
  std::int64_t rows = 0;   ///< written so far
  Archive features{};      ///< of model, integrator and start: those of the run that goes on must be the same
  Archive numbers{};

  friend bool operator==(const RunState&, const RunState&) = default;
};

}  // namespace freeplay
