// Continuation: follows a closed mechanism in small steps of what is prescribed.
#pragma once

#include <functional>
#include <span>

#include "assembly/closed_mechanism.h"

namespace freeplay {

constexpr double first_drive_step = 0.02;      ///< rad, or of the size of the model
constexpr int most_followed_velocities = 200;  ///< of a mechanism: the work grows with their cube

/// A small step: `prescribe` changes what leads, the time or both. `ahead`: where it is likely to lead, as an increment
/// of the position, or empty. False, and the position as before, where the mechanism does not follow.
bool follow(ClosedMechanism& mechanism, const std::function<void()>& prescribe, std::span<const double> ahead = {});

/// From a singular position, where the mechanism may go on in two ways, with the last lead to larger values (sign 1) or
/// smaller ones (-1). False, and all as before, where there is no way on.
bool leave_dead_point(ClosedMechanism& mechanism, double sign);

}  // namespace freeplay
