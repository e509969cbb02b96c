// Parameters that are lists of numbers or tables of points.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "base/unit.h"
#include "component/parameter_block.h"
#include "format/checked_value.h"

namespace freeplay {

/// `[1 mm, 2 mm]`, within the bounds and as long as `parameter` says. Null after a message at the place that is wrong.
/// Each number gets its place, "NAME.INDEX", in `places`.
std::shared_ptr<const ParameterPoints> read_list(const Parameter& parameter, const Unit& unit,
                                                 const CheckedValue& written,
                                                 std::map<std::string, CheckedValue>& places);

/// `[[0 m/s, 0.3], [1 m/s, 0.1]]`: the first numbers have the dimension `of_x` and rise. As read_list().
std::shared_ptr<const ParameterPoints> read_table(const Parameter& parameter, const Dimension& of_x, const Unit& unit,
                                                  const CheckedValue& written,
                                                  std::map<std::string, CheckedValue>& places);

}  // namespace freeplay
