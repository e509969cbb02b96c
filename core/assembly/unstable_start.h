// UnstableStart: a mechanism that starts at rest where what acts moves it neither way, and would carry it off either.
#pragma once

#include <optional>
#include <string>

#include "system/state.h"
#include "system/system.h"

namespace freeplay {

struct UnstableStart {
  BodyId body = ground;  ///< that would move most
  double growth = 0.0;   ///< of a small deviation, e-fold [1/s]
  double beside = 0.0;   ///< how far it is from the equilibrium [m]; 0: in it
};

/// Of the ideal mechanism, in the state in which a run of `system` begins. Only where loads leave it at rest for the
/// whole run, or would do so at a place within its accuracy, and a deviation would grow within it.
std::optional<UnstableStart> unstable_start(const System& system, const State& start);
/// "starts at rest in ...", why, and what to do.
std::string words_of(const UnstableStart& start);

}  // namespace freeplay
