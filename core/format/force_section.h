// The section `forces`.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Adds the forces of a part; all frames are known.
void add_forces(Draft& draft, const Part& part);

}  // namespace freeplay
