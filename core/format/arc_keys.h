// Curves of arcs and lines in place of a formula.
#pragma once

#include "component/parameter_block.h"
#include "format/checked_value.h"

namespace freeplay {

/// `curve: {arcs: [[x, y, radius], ...], roller: r}`: over an angle a closed curve, over a length an open one; the
/// value is a length. Makes `value` serve it; false after an error.
bool read_arcs(const CheckedValue& written, const Dimension& of_x, const Dimension& of_value, ParameterValue& value);

}  // namespace freeplay
