// The section `analysis`, which is checked whether a command uses it or not.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Fills Model::analysis; joints and drivers are known.
void read_analysis(Draft& draft, const CheckedValue& section);

}  // namespace freeplay
