// The key `table` of a driver: a time table in the model or in a file beside it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "format/draft.h"

namespace freeplay {

/// Reads `table`, whose values have the dimension of the driver. A file is read once, however often it is named, and
/// becomes an input of the model. Null after an error. `source`, where it is wanted, becomes what is written.
std::shared_ptr<const TimeTable> read_table(Draft& draft, const CheckedValue& value, const Dimension& dimension,
                                            TableSource* source = nullptr);

/// What numbers in this unit are multiplied by to be SI: 1 without one.
std::optional<double> unit_factor(const std::optional<CheckedValue>& value, const Dimension& wanted);
/// Place in the list of words: 0 without one.
std::optional<int> word_place(const std::optional<CheckedValue>& value, const std::vector<std::string>& words);

}  // namespace freeplay
