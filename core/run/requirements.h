// What a run needs of its model, asked before it begins.
#pragma once

#include "system/system.h"

namespace freeplay {

/// Throws Error{plugin} "plugin-failed" when the integrator cannot declare what it needs.
void require_sound_integrator(const System& system);

/// Throws Error{input} "out-of-range", in the file where it says so, when the error allowed in a step is below the
/// rounding of positions.
void require_attainable_accuracy(const System& system);

}  // namespace freeplay
