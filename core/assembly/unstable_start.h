// UnstableStart: a mechanism that starts at rest where what acts moves it neither way, and would carry it off either.
#pragma once

#include <optional>

#include "system/state.h"
#include "system/system.h"

namespace freeplay {

struct UnstableStart {
  BodyId body = ground;  ///< that would move most
  double growth = 0.0;   ///< of a small deviation, e-fold [1/s]
};

/// Of the ideal mechanism, in the state in which a run of `system` begins. Only where loads leave it at rest for the
/// whole run, and a deviation would grow within it.
std::optional<UnstableStart> unstable_start(const System& system, const State& start);

}  // namespace freeplay
