// Working modes of legs that follow a path through the whole mechanism.
#pragma once

#include <span>

#include "model/model.h"

namespace freeplay {

/// Bends the leg that `joint` drives and that ends at `marker`, where it is one of a crank and a coupler, as below.
bool bend_leg(const Model& model, int joint, int marker, int elbow, std::span<double> q);

/// Bends every leg of an inverse-kinematics entry to the side that its `elbow` gives; where the file gives none but a
/// pose for the crank or the coupler, that pose decides. With d from pin A to pin C, the
/// crank's direction A to B is turned counter-clockwise from d for 1, clockwise for -1. Mirrors crank and coupler about
/// the line A C, which leaves the pins A, B and C closed as they were. `q`: x, y, angle of each centre of mass. True
/// when a leg was bent.
bool bend_legs(const Model& model, const InverseKinematics& entry, std::span<double> q);

}  // namespace freeplay
