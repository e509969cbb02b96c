// The section `frames`, and the frames under `bodies`.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Adds the frames of a part: those under its bodies and those of its section `frames`. All bodies are known.
void add_frames(Draft& draft, const Part& part);

}  // namespace freeplay
