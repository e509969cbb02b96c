// Formulas of components: an expression called through the plain functions that cross the plugin boundary.
#pragma once

#include "base/error.h"
#include "base/expression.h"
#include "component/parameter_block.h"

namespace freeplay {

/// Makes `value` serve the formula that is written at `begin`; with `places_inside` the text stands there as it is, so
/// that characters of it are places in the file. Where it has no value, its call fails as that of a written function
/// of time (model/time_function.h).
void set_formula(ParameterValue& value, const Expression& expression, Location begin, bool places_inside);

/// Fills `message` with a place in a written text and why an expression there has no value, for a plugin to pass on.
Status tell_failure(const Location& begin, bool places_inside, const EvaluationFailure& failure, Message& message);

}  // namespace freeplay
