// DoubtfulCurve: curves by an angle that is written in degrees, though it is one in radians.
#pragma once

#include "base/expression.h"
#include "format/checked_value.h"
#include "format/table_variables.h"

namespace freeplay {

/// `doubtful-angle` for a length by the angle alone, as of a cam, that is the same all the way round where its angle is
/// in radians, but not where it is in degrees.
void doubt_curve(const Expression& formula, const TableVariables& variables, const Dimension& of_value,
                 const CheckedValue& written);

}  // namespace freeplay
