// Time functions of components: an expression behind the plain function that crosses the plugin boundary.
#pragma once

#include <optional>

#include "base/expression.h"
#include "component/parameter_block.h"

namespace freeplay {

/// Makes `value` serve the expression, or the constant when there is one.
void set_function(ParameterValue& value, Expression expression, std::optional<double> constant);

}  // namespace freeplay
