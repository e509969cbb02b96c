// Values of parameters for samples: numbers of a usual size, functions, formulas, lists and tables.
#pragma once

#include <cstddef>
#include <memory>

#include "base/unit.h"
#include "component/parameter_block.h"

namespace freeplay {

/// How the numbers of one unit are distinguished: constructors compare lengths or speeds with each other.
enum class SampleOrder { rising, falling, equal };

/// A size that occurs in mechanisms [SI].
double usual_size(const Dimension& d);

/// The number nearest to `wish` that lies within the bounds.
double within(const Parameter& p, double factor, double wish);

/// f(t) = c (1 + sin(2 t)/2): a function whose three values differ from each other.
void set_sample_function(double size, ParameterValue& value);

/// f(x, ...) = c x: a formula that rises with its first variable alone.
void set_sample_formula(double slope, ParameterValue& value);

/// f(x, ...) = c (1 + cos(x)/5): a round closed curve as a distance over the angle.
void set_closed_sample(double size, ParameterValue& value);

/// Numbers about `size` within the bounds, for a list, or as the y of a table whose x are multiples of `x_size`: from 0
/// on, from one on, or to both sides of 0, by the order.
std::shared_ptr<const ParameterPoints> sample_points(const Parameter& p, double factor, double size, double x_size,
                                                     SampleOrder order, std::size_t length);

}  // namespace freeplay
