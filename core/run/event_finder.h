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
  /// Its derivative.
  double slope(double s) const {
    const double c = 1.0 - s;
    return 6.0 * s * c * (value1 - value0) + c * (1.0 - 3.0 * s) * slope0 + s * (3.0 * s - 2.0) * slope1;
  }
  /// Its second derivative.
  double bend(double s) const {
    return 6.0 * (1.0 - 2.0 * s) * (value1 - value0) + (6.0 * s - 4.0) * slope0 + (6.0 * s - 2.0) * slope1;
  }
  /// The same cubic over the next interval, of the length `part` of this one.
  Hermite ahead(double part) const {
    const double bend = 6.0 * (value0 - value1) + 2.0 * slope0 + 4.0 * slope1;  // second derivative at the end
    const double twist = 12.0 * (value0 - value1) + 6.0 * (slope0 + slope1);    // third
    const double value = value1 + part * (slope1 + part * (0.5 * bend + part * twist / 6.0));
    return {value1, part * slope1, value, part * (slope1 + part * (bend + 0.5 * part * twist))};
  }
};

/// First s in (from, 1] where the cubic passes zero upwards. A contact that opens and closes inside the step is found
/// at the extremum between.
std::optional<double> first_rise(const Hermite& curve, double from);

}  // namespace freeplay
