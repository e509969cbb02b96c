// The period of a formula, as its operations show it.
#pragma once

#include <optional>

#include "base/expression.h"

namespace freeplay {

/// The least time after which both come again, 0 standing for what is constant; none where no number of the one is a
/// number of the other, of up to a thousand.
std::optional<double> common_period(double a, double b);

/// How a formula comes again from `from` to `to` [s].
struct Recurrence {
  double slope = 0.0;   ///< what it grows by each second besides
  double period = 0.0;  ///< [s]; 0 where nothing but that is left
};
/// Sines of straight lines of t come again, and with them whatever is made of them alone, however short it lasts; a
/// side of min, max, abs and smooth() that is the same from `from` to `to` counts as what it is there. None where t
/// enters in another way. Of several periods that it may have the formula is looked at to find the least: in 256
/// instants and in eight between any two of its corners.
std::optional<Recurrence> recurrence(const Expression& expression, double from, double to);

}  // namespace freeplay
