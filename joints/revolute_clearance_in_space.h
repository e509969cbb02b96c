// The class of `revolute-clearance` for spatial models, and what its parameters share with those of other pins.
#pragma once

#include "freeplay/kit/play_parameters.h"
#include "freeplay/plugin.h"

namespace freeplay {

JointFace revolute_clearance_in_space();
/// The same without shoulders, for `cylindrical_clearance.cpp`.
JointFace cylindrical_clearance_in_space();

/// What a bearing has beside radii, laws and a start.
inline constexpr Parameter bearing_length_rows[] = {
    play::length("clearance.length",
                 "Axial length of the contact, for laws that need it; in space that of the bearing."),
    {.name = "clearance.axial_clearance",
     .unit = "m",
     .default_value = optional,
     .minimum = 0.0,
     .summary = "Spatial models: play of the journal's shoulders along the axis, to each side; the radial clearance "
                "unless given."}};

}  // namespace freeplay
