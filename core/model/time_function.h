// Time functions of components: an expression called through the plain function that crosses the plugin boundary.
#pragma once

#include "base/error.h"
#include "base/expression.h"
#include "component/parameter_block.h"

namespace freeplay {

/// Makes `value` serve a constant.
void set_function(ParameterValue& value, double constant);
/// Makes `value` serve the expression that is written at `begin`; with `places_inside` the text stands there as it is,
/// so that characters of it are places in the file. Where it has no value, its call fails with Status::bad_parameter,
/// the id of the failure and a text that begins with the place: so a type that passes the failure on shows that not it
/// but the model file is at fault.
void set_function(ParameterValue& value, Expression expression, Location begin, bool places_inside);

/// The expression that `value` serves, or null where it serves a constant or is no function of time.
const Expression* written_expression(const ParameterValue& value);

}  // namespace freeplay
