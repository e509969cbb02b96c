// The key `columns` of `simulation.output`: result columns that are formulas of others.
#pragma once

#include "format/checked_value.h"

namespace freeplay {

/// Reads the entries into Settings::columns of `model`, all elements of which must be known.
void read_output_columns(const CheckedValue& value, Model& model);

}  // namespace freeplay
