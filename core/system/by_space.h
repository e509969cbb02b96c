// by_space: code that is written once for bodies in the plane and in space.
#pragma once

#include "system/planar_kinematics.h"
#include "system/spatial_bodies.h"

namespace freeplay {

/// Calls `body` with the bodies of the space, planar::Bodies{} or spatial::Bodies{}.
template <class Body>
auto by_space(Space space, Body&& body) {
  return space == Space::planar ? body(planar::Bodies{}) : body(spatial::Bodies{});
}

}  // namespace freeplay
