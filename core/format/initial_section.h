// The section `initial`.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Start values of joints and the tolerance of the assembly; all joints and drivers are known.
void read_initial(Draft& draft, const CheckedValue& section);

}  // namespace freeplay
