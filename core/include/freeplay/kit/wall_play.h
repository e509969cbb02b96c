// Joints whose play lies between two walls along the x axis of the first marker: their laws, and where they start.
#pragma once

#include <cmath>
#include <string>

#include "freeplay/kit/planar_contacts.h"

namespace freeplay::play {

/// What laws may know of a flat wall of a and what touches it with that play to each side [m]: a corner of b, or a pin
/// or a ball, whose radius may be known [m].
inline ContactPair at_wall(SurfaceShape shape, double play, double radius = not_a_number) {
  ContactPair pair{not_a_number, radius, play, not_a_number, {}, {}};
  pair.bearing_shape = SurfaceShape::plane;
  pair.journal_shape = shape;
  return pair;
}
/// The laws of a block `clearance` for such a pair, with its materials. Throws BadParameter.
inline PlanarLaws wall_laws(const Parameters& p, ContactPair pair) {
  read_materials(p, pair);
  return {p, pair};
}
/// The same where nothing is known of what touches the wall: a law computes no stiffness from radii.
inline PlanarLaws wall_laws(const Parameters& p, double play) {
  return wall_laws(p, at_wall(SurfaceShape::unknown, play));
}

/// The key `initial`: where b starts across the walls.
struct WallStart {
  explicit WallStart(const Parameters& p) {
    const int word = p.word("clearance.initial");
    loaded = word == 1;
    if (word >= 0) return;
    shift = across(p, "clearance.initial.eccentricity");
    shift_rate = across(p, "clearance.initial.velocity");
  }
  static double across(const Parameters& p, const char* path) {
    const auto value = p.vector(path);
    if (value[0] != 0.0)
      throw BadParameter(path, "out-of-range",
                         "its first number, along the walls, must be 0: the joint is free there; `initial: {joints: "
                         "...}` of the model sets it");
    return value[1];
  }
  bool loaded = false;
  double shift = 0.0, shift_rate = 0.0;  // [m], [m/s]
};

/// Direction across the walls, world axes, at the start of a joint; of the world where it is not known yet.
inline Eigen::Vector2d across_walls(const InitialOffset& offset) {
  return offset.rotation == nullptr ? Eigen::Vector2d(0.0, 1.0)
                                    : Eigen::Vector2d(offset.rotation[1], offset.rotation[4]);
}
/// Leaves the rest of the start zero.
inline void write_start(const Eigen::Vector2d& n, double shift, double shift_rate, InitialOffset& out) {
  clear_start(out);
  for (int i = 0; i < 2; ++i) {
    out.position[i] = shift * n[i];
    out.velocity[i] = shift_rate * n[i];
  }
}

/// How far b stands from the middle where one contact carries `force` [N] along n at rest; `sag` [m] draws the contact
/// away from its wall.
inline double rest_at_wall(const ContactLawRef& law, double play, double force, double sag) {
  const double size = std::abs(force);
  if (size < 1e-12) return 0.0;
  return -std::copysign(play + sag + resting_penetration(law, play, size), force);
}

inline constexpr Parameter wall_start_rows[] = {
    {.name = "clearance.initial",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "centered|loaded",
     .summary = "Start between the walls: in the middle, resting where static contact carries the load, or a map."},
    {.name = "clearance.initial.eccentricity",
     .kind = ParameterKind::vector,
     .unit = "m",
     .default_value = optional,
     .summary = "Place of the second origin at the start in the axes of the walls: 0 along them, then across."},
    {.name = "clearance.initial.velocity",
     .kind = ParameterKind::vector,
     .unit = "m/s",
     .default_value = optional,
     .summary = "Its velocity across the walls at the start, in the same axes."},
};

}  // namespace freeplay::play
