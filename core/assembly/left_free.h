// LeftFree: what moves in a mechanism whose drivers all stand still, and whether that looks meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "system/system.h"

namespace freeplay {

/// Motions within the kernel of the rows, without spins of single bodies about their centres of mass that nothing else
/// notices: of rollers, of rods between two balls.
struct LeftFree {
  int motions = 0;
  std::vector<BodyId> bodies;  ///< that they move
  /// Says that no start is given for some of them, or that nothing acts on them, or that a wheel on its own bearing
  /// never turns; empty where that is not so.
  std::string doubt;
  BodyId doubtful = ground;  ///< the first of these
};

/// Of a system with every clearance closed, evaluated at its start.
LeftFree left_free(const System& closed, const Evaluation& at_start);

/// Whether the file gives a body a speed.
bool has_velocity(const Body& body);

}  // namespace freeplay
