// Warm start: a run begins where another one of nearly the same mechanism has ended.
#pragma once

#include <vector>

#include "assembly/assembly.h"

namespace freeplay {

/// An accepted state of all bodies, as Layout of the whole system has it.
struct EndedMotion {
  double t = 0.0;
  std::vector<double> q, v, z, h;
};

/// Makes `start`, as assemble() has left it with `system`, begin at Settings::start where `motion` has ended: angles of
/// driven joints, and of what turns with them, are moved by whole turns to what their drivers prescribe there, times in
/// histories with the time; then positions change as little as the constraints ask for in m and rad, and velocities in
/// kinetic energy, with the clearances left open. Throws Error{numerical} "warm-start" where a joint with play moves by
/// more than its clearance, another one is open by more than 1e-3 of the size of the model, or the mechanism has other
/// coordinates.
void start_from(System& system, const EndedMotion& motion, Start& start);

}  // namespace freeplay
