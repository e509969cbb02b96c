// The section `analysis`, which is checked before any command uses it.
#pragma once

#include "model/draft.h"

namespace freeplay {

void check_analysis(Draft& draft, const CheckedValue& section);

}  // namespace freeplay
