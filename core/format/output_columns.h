// The key `columns` of `simulation.output`: result columns that are formulas of others.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "format/checked_value.h"

namespace freeplay {

/// Reads the entries, and further formulas with the names of their columns, into Settings::columns of `model`, all
/// elements of which must be known.
void read_output_columns(const std::optional<CheckedValue>& columns,
                         const std::vector<std::pair<std::string, CheckedValue>>& formulas, Model& model);

}  // namespace freeplay
