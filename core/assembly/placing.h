// Placing walk: the first guess of where bodies stand, joint by joint from the ground.
#pragma once

#include <span>

#include "system/system.h"

namespace freeplay {

/// Fills q (centres of mass and angles) as model-format section 9, step 1 describes. `coordinates` are the values that
/// joints lead or are driven to at the start; NaN where there is none. Throws Error{input} "ik-unreachable".
void place_bodies(const System& closed, std::span<const double> coordinates, std::span<double> q);

/// Fills v from the velocities that the file gives the bodies' frames, where they stand by q.
void start_velocities(const System& closed, std::span<const double> q, std::span<double> v);

/// Turns a motion that has no value into an Error; `category` numerical once the run has begun.
[[noreturn]] void throw_motion_fault(const Model& model, const MotionFault& fault, Error::Category category);

}  // namespace freeplay
