// Parameters that are lists of numbers or tables of points.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "base/unit.h"
#include "component/parameter_block.h"
#include "format/draft.h"
#include "format/parameter_check.h"

namespace freeplay {

/// `[1 mm, 2 mm]`, or the column of a file beside the model, within the bounds and as long as `parameter` says. Null
/// after a message at the place that is wrong. Each number gets its place, "NAME.INDEX", in `checked`.
std::shared_ptr<const ParameterPoints> read_list(Draft& draft, const Parameter& parameter, const Unit& unit,
                                                 const CheckedValue& written, CheckedParameters& checked);

/// `[[0 m/s, 0.3], [1 m/s, 0.1]]`, or two columns: the first numbers have the dimension `of_x` and rise. As
/// read_list().
std::shared_ptr<const ParameterPoints> read_table(Draft& draft, const Parameter& parameter, const Dimension& of_x,
                                                  const Unit& unit, const CheckedValue& written,
                                                  CheckedParameters& checked);

}  // namespace freeplay
