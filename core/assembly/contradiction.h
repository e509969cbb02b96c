// Conditions that a mechanism cannot fulfil together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assembly/closed_mechanism.h"

namespace freeplay {

/// What holds positions of a mechanism: a joint or gear, a driver, a start value of a joint, or a path.
struct Condition {
  enum class Kind { joint, driver, start, path };
  Kind kind = Kind::joint;
  int index = 0;  ///< into Model::joints, Model::drivers, ClosedMechanism::leads or Model::kinematics
};

/// Of conditions that do not hold together as few as contradict each other: without any one of them the others can be
/// fulfilled. One is left out after the other, and Newton's method says from many positions whether the rest can be:
/// joint `open`, if not -1, is known to be one of them. `gap`: what is missed, lengths by the size of the model, and
/// rad; a thousandth of it counts as closed. Empty where the search would take too long, is not sure, or finds that all
/// can be fulfilled. The state stays.
std::vector<Condition> contradiction(ClosedMechanism& mechanism, int open, double gap);

/// "joints 'A' and 'B', driver 'motor' and the start value of 'C' contradict each other (bodies 'crank' and 'rod')".
std::string words(const std::vector<Condition>& conditions, const ClosedMechanism& mechanism);

}  // namespace freeplay
