// The section `bodies`.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Adds the bodies of a part. Their frames follow in add_frames(), when all bodies are known.
void add_bodies(Draft& draft, const Part& part);

}  // namespace freeplay
