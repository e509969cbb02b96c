// DoubtfulBody: masses, inertias and lengths of bodies against each other.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Beyond these a body is doubted; docs/trust.md tells them with examples.
namespace body_limit {
/// Radius of gyration, in terms of how far the body's frames reach and of the mechanism's lengths. A homogenous body
/// that reaches no farther than its frames has at most 1.
inline constexpr double gyration = 10.0;
/// Reach of the frames in radii of gyration: of any body (a ball of 1 mm on a wire of 0.6 m), and of one whose centre
/// of mass lies between its frames (a rod has 1.7).
inline constexpr double slender = 1000.0, slender_between = 100.0;
/// Density [kg/m^3] of a body as large as its radius of gyration allows; osmium has 22590, a long roller seems denser.
inline constexpr double density = 1e6;
/// The same without a unit, if it is also this many times that of the other bodies.
inline constexpr double bare_density = 1e5, bare_density_ratio = 300.0;
/// Least density of the box around the frames [kg/m^3], of bodies that reach this far [m]: a steel wire 25 000 times as
/// long as thick.
inline constexpr double thinnest = 1e-5, thin_reach = 5.0, thin_mass = 1e-4;
/// Distance of the centre of mass from the box around the frames, in lengths of that box and in radii of gyration (a
/// homogenous rod held at its end has 1.7).
inline constexpr double com_outside = 0.5, com_outside_gyration = 2.0;
/// How many times smaller the moment across the line of the frames is than that about it, in space.
inline constexpr double axis_ratio = 20.0;
}  // namespace body_limit

/// Middle one of the distances of frames from their body's centre of mass, of all bodies that have any; half the extent
/// of ground's frames counts as one. 0 when there is none [m].
double length_scale(const Draft& draft);

/// Warns `doubtful-inertia`, `doubtful-mass`, `doubtful-length` and `doubtful-com`, at most one for each body, once all
/// is read.
void doubt_bodies(const Draft& draft);

/// The entry `name` (a full name) of a section, as it is written; nothing when no part has it.
std::optional<CheckedValue> entry_of(const Draft& draft, const std::string& section, const std::string& name);

}  // namespace freeplay
