// Formulas of components that go through given points.
#pragma once

#include <string>
#include <vector>

#include "component/parameter_block.h"
#include "model/time_table.h"

namespace freeplay {

/// Makes `value` serve a function of the formula's first variable through the points (x, y), x increasing: straight
/// lines, whose slope jumps at each point between them, or a cubic spline (C2). Beyond natural ends it goes straight
/// on; with periodic ones, where the first and the last y agree, it repeats. Returns the table, which `value` owns.
const TimeTable& set_table_formula(ParameterValue& value, std::vector<double> x, std::vector<double> y,
                                   Interpolation interpolation, SplineEnds ends);

}  // namespace freeplay
