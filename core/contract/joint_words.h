// JointWords: what findings about joints say of a moment, of the twelve components and of what apply() gives.
#pragma once

#include <string>

#include "contract/joint_probe.h"

namespace freeplay {

/// "at t = 0.53 s with b at (0.1, -0.2, 0) m from a, turned by 0.3 rad": enough to see the case, world axes.
std::string words_of(const JointMoment& moment);

/// Component of [twist a, twist b]: "vx of a", "wz of b".
std::string twist_word(std::size_t component);

/// Row of the derivatives of apply(): "Fx on a", "Mz on b", "rate of z0".
std::string force_word(std::size_t row);

/// Column of the derivatives of apply(): "x of a", "turn z of b", "vx of a", "wz of b", "z0".
std::string input_word(std::size_t column);

}  // namespace freeplay
