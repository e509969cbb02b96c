// PlayBypass: a joint with play whose bodies ideal joints hold together where its journal is to move.
#pragma once

#include <vector>

#include "system/system.h"

namespace freeplay {

struct PlayBypass {
  int joint = 0;        ///< with play
  std::vector<int> by;  ///< ideal joints; one where one of them does it alone
  bool whole = false;   ///< they hold all that the joint holds
  bool direct = false;  ///< they are between the same two bodies; else between bodies that are fixed to these
  int directions = 0;   ///< of the play that they take
};

/// Of the closed system (term_position), between the same two bodies or what is fixed to them without play. An ideal
/// joint that holds the axis of a pin alone, as a thrust bearing, or a point of the bodies elsewhere, about which the
/// journal can still tilt, takes nothing of the play.
std::vector<PlayBypass> play_bypasses(const System& closed, const Evaluation& at_start);

}  // namespace freeplay
