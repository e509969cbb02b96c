// DriveRange: how far the ideal mechanism lets a driven joint move.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "assembly/closed_mechanism.h"

namespace freeplay {

/// Coordinates [rad or m] between which a joint can move while everything else that holds the mechanism holds; infinite
/// where nothing ends the way: after a whole turn, or after three times the size of the model.
struct DriveRange {
  double from = -std::numeric_limits<double>::infinity(), to = -from;
  bool limited() const { return from > -std::numeric_limits<double>::infinity() || to < -from; }
};

/// Follows the mechanism from its state, where its rows hold with `joint` leading (the last of the leads), both ways
/// up to where it cannot follow any more, to 1e-6 of a radian or of the model's size. Steps become as short as that
/// where the rows come close to depending on each other, so that a gap in the way, as of links that are nearly long
/// enough, is not leapt over. The state stays.
DriveRange drive_range(ClosedMechanism& mechanism);

/// "turn from -97.2 deg to 97.2 deg", "move up to 0.12 m": of a joint of the coordinate.
std::string words(const DriveRange& range, Coordinate coordinate);
/// "97.2 deg" or "0.12 m".
std::string words(double value, Coordinate coordinate);

/// Of a mechanism whose rows do not hold: which of its leading or driven joints would have to stand elsewhere, and in
/// which range, for it to close. The state is lost.
std::optional<std::string> closes_elsewhere(ClosedMechanism& mechanism);

}  // namespace freeplay
