#include "freeplay/kit/play_parameters.h"
#include "revolute_clearance_in_space.h"

namespace freeplay {
namespace {

constexpr Parameter sleeve_rows[] = {
    {.name = "clearance.length",
     .unit = "m",
     .default_value = required,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Length of the sleeve along the axis; its middle is the first frame."},
};
constexpr auto cylindrical_clearance_parameters =
    play::joined(play::radius_rows, sleeve_rows, play::law_rows, play::start_rows, play::tilt_start_rows);

}  // namespace

Component cylindrical_clearance() {
  const JointFace face = cylindrical_clearance_in_space();
  return {
      ComponentKind::joint,
      face.table,
      face.create,
      {.name = "cylindrical-clearance",
       .space = Space::spatial,
       .summary = "Shaft with play in a sleeve, which touches it at both ends by a contact law; it goes along and "
                  "turns.",
       .formula =
           "at each end z_a = +-length/2 of the sleeve: e = eccentricity of the shaft's axis there, delta = |e| - "
           "c, half of the force of the law across the shaft's axis and half of the friction against the slip, "
           "its part along the axis included.",
       .validity = "Clearance small against the radii; a shaft that is longer than its way; rigid rings apart from "
                   "the ends.",
       .references = "Flores and Lankarani 2016, Contact Force Models for Multibody Dynamics; Brutti, Coglitore and "
                     "Valentini 2011, Nonlinear Dyn 65, 179-193",
       .parameters = {cylindrical_clearance_parameters.data(), cylindrical_clearance_parameters.size()},
       .ideal = "cylindrical",
       .block = "clearance",
       .first_end = "sleeve",
       .second_end = "shaft",
       .axis = MarkerAxis::z}};
}

}  // namespace freeplay
