// The key `table` of a driver: a time table in the model or in a file beside it.
#pragma once

#include <memory>

#include "format/draft.h"

namespace freeplay {

/// Reads `table`, whose values have the dimension of the driver. A file is read once, however often it is named, and
/// becomes an input of the model. Null after an error. `source`, where it is wanted, becomes what is written.
std::shared_ptr<const TimeTable> read_table(Draft& draft, const CheckedValue& value, const Dimension& dimension,
                                            TableSource* source = nullptr);

}  // namespace freeplay
