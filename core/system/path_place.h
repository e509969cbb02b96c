// Where on its path an entry of inverse kinematics is, in words.
#pragma once

#include "model/model.h"

namespace freeplay {

/// Writes ", where x = ..." with the numbers that the path gives at t, into [to, end) without a terminating zero;
/// returns the end of it. Nothing where it has no value.
char* write_place_on_path(const Model& model, int kinematics, double t, char* to, char* end) noexcept;

}  // namespace freeplay
