// Where a function given by values and slopes at the ends of a step crosses zero inside it.
#pragma once

#include <optional>

namespace freeplay {

/// Cubic of value and slope at the ends of the unit interval; slopes are per unit (rate times step).
struct Hermite {
  double value0, slope0, value1, slope1;

  double at(double s) const {
    const double c = 1.0 - s;
    return value0 * (1.0 + 2.0 * s) * c * c + slope0 * s * c * c + value1 * s * s * (3.0 - 2.0 * s) -
           slope1 * s * s * c;
  }
};

/// First s in (from, 1] where the cubic passes zero upwards. A contact that opens and closes inside the step is found
/// at the extremum between.
std::optional<double> first_rise(const Hermite& curve, double from);

}  // namespace freeplay
