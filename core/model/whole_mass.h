// WholeMass: mass and length that numbers of a mechanism are judged by.
#pragma once

#include "model/model.h"

namespace freeplay {

/// Largest distance of a frame that something stands on from its body's centre of mass, or of ground's frames and the
/// given poses from the origin [m]; 0 where there is none.
double model_length(const Model& model);
/// The same, but 1 where there is none.
double model_size(const Model& model);

/// Of all bodies.
struct WholeMass {
  double mass = 0.0, inertia = 0.0;  ///< [kg]; of each the largest moment about its centre of mass [kg m^2]
  /// Accelerations that one load would give to all of them together, in a mechanism of this size [m/s^2].
  double by_force(double force) const { return force / mass; }
  double by_torque(double torque, double size) const { return torque * size / (inertia + mass * size * size); }
};
WholeMass whole_mass(const Model& model);

/// Whether some joint holds a body to ground: a planet may be fast, a mechanism on ground not.
bool is_on_ground(const Model& model);

/// What no machine has of such accelerations. Of a gun 6e4 move the bolt; a toggle clamp holds 1e4 times its mass.
inline constexpr double most_of_load = 1e5;  // [m/s^2]

}  // namespace freeplay
