// DoubtfulBody: masses, inertias and lengths of bodies against each other.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Beyond these a body is doubted; docs/trust.md gives them with examples.
namespace body_limit {
/// Radius of gyration, in terms of how far the body's frames reach and of the mechanism's lengths, of a body that would
/// have less mass than `sheet` [kg/m^2] on the disc with this radius of gyration; and of any. A homogenous body that
/// reaches no farther than its frames has at most 1; a flywheel of steel has 500 kg/m^2, a bicycle wheel 2.
inline constexpr double gyration = 10.0, sheet = 0.5, any_gyration = 300.0;
/// Mass on the disc with the radius of gyration of a rotor, where nothing of the model has a length [kg/m^2], as foils
/// of solar sails have 0.005; and that radius [m], as bodies that slide alone have any inertia.
inline constexpr double foil = 1e-4, lone_gyration = 10.0;
/// Mass by the cube of the radius of gyration [kg/m^3], of a body that reaches less far than `past_reach` of that
/// radius, which is longer than `large` [m]: air has 1.2, a ball of it would be lighter than a balloon.
inline constexpr double airy = 3.0, past_reach = 1.0 / 1.5, large = 1.0;
/// A body with a single frame is at least as long as its radius of gyration if its centre of mass is as far from that
/// frame as this part of it: nearer, it is an unbalanced rotor, and the distance no length of the mechanism.
inline constexpr double arm = 0.3;
/// Reach of the frames in radii of gyration: of any body (Foucault's pendulum has 1800), and of one whose centre of
/// mass lies between its frames (a rod has 1.7).
inline constexpr double slender = 5000.0, slender_between = 40.0;
/// Density [kg/m^3] of a body as large as its radius of gyration allows; osmium has 22590, a long roller seems denser.
inline constexpr double density = 1e6;
/// The same without a unit, if it is also this many times that of the other bodies.
inline constexpr double bare_density = 1e5, bare_density_ratio = 300.0;
/// Least density of the box around the frames [kg/m^3], of bodies that reach this far [m] and say no unit: a steel wire
/// 25 000 times as long as thick. Ropes are as thin: with a unit only what has less mass on its length [kg/m] than a
/// thread is doubted.
inline constexpr double thinnest = 1e-5, thin_reach = 5.0, thin_mass = 1e-4, thread = 1e-5;
/// Distance of the centre of mass from the box around the frames, in lengths of that box and in radii of gyration (a
/// homogenous rod held at its end has 1.7), if the radius of gyration is that of a body of this box, in lengths of it.
/// Farther than `lump` radii of gyration it is a lump on an arm, unless farther than `far` boxes.
inline constexpr double com_outside = 0.5, com_outside_gyration = 2.0, lump = 4.0, far = 3.0;
inline constexpr double least_of_box = 0.15, most_of_box = 0.6;
/// Distance of the centre of mass of a body on one joint from it, without a unit: in lengths of the mechanism, of which
/// a load on a rope has 30, and in radii of gyration; of one with several frames.
inline constexpr double lone_com = 20.0, lone_com_gyration = 300.0, linked_com_gyration = 30.0;
/// How many times smaller the moment across the line of the frames is than that about it, in space.
inline constexpr double axis_ratio = 12.0;
}  // namespace body_limit

/// Middle one of the distances of frames from their body's centre of mass, of all bodies that have any but for
/// unbalanced rotors; half the extent of ground's frames counts as one. 0 when there is none [m].
double length_scale(const Draft& draft);

/// Warns `doubtful-inertia`, `doubtful-mass`, `doubtful-length` and `doubtful-com`, at most one for each body, once all
/// is read.
void doubt_bodies(const Draft& draft);

/// The entry `name` (a full name) of a section, as it is written; nothing when no part has it.
std::optional<CheckedValue> entry_of(const Draft& draft, const std::string& section, const std::string& name);

}  // namespace freeplay
