// Likely cause: which number of the model explains that a run came to nothing that can be.
#pragma once

#include <string>

#include "system/system.h"

namespace freeplay {

/// Diagonal of the box about a body's origin, its centre of mass and its frames [m]; 0 where they all are one point.
double extent(const Model& model, BodyId body);

/// Of inertias, masses, lengths, moduli of elasticity, gravity, speeds of drivers and the step (`dt` [s]) that one
/// which is farthest outside of what machines have, as a sentence without full stop: "inertia of 'coupler' is 250 kg
/// m^2 for a mass of 0.21 kg: its radius of gyration would be 34 m". Empty when all are inside. `e` is evaluated where
/// the run stands, and `joint` is the one that went wrong; -1: none in particular.
std::string likely_cause(const System& system, const Evaluation& e, double dt, int joint);

}  // namespace freeplay
