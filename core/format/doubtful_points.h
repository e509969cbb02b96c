// DoubtfulPoints: cubics that leave the points which they go through.
#pragma once

#include <string>

#include "format/checked_value.h"
#include "model/time_table.h"

namespace freeplay {

/// What a message says of the variable of a table, as of "t" in " s", and of its values.
struct PointWords {
  std::string variable, variable_unit;  ///< units after a blank; "": none, or not known
  std::string unit{};
  double along = unbounded;     ///< limit beside two points, see below
  bool may_be_straight = true;  ///< may lines take the place of the cubic?
};

/// `doubtful-value` for a cubic that swings by a quarter of the range of its points beyond all of them, as after a
/// short pulse; or by the part `along` of it beyond two of them, where the points around these go on rising, falling or
/// staying as they are.
void doubt_overshoot(const TimeTable& table, const CheckedValue& written, const PointWords& words);

}  // namespace freeplay
