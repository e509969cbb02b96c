// The section `sweep`, which is checked before any command uses it.
#pragma once

#include "format/draft.h"
#include "format/parameter_scope.h"

namespace freeplay {

/// `parameters` are those of the top level.
void check_sweep(Draft& draft, const CheckedValue& section, const ParameterScope& parameters);

}  // namespace freeplay
