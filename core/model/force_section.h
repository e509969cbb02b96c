// The section `forces`.
#pragma once

#include "model/draft.h"

namespace freeplay {

/// Adds the forces of a part; all frames are known.
void add_forces(Draft& draft, const Part& part);

}  // namespace freeplay
