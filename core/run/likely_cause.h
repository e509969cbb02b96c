// Likely cause: which number of the model explains that a run came to nothing that can be.
#pragma once

#include <span>
#include <string>

#include "system/system.h"

namespace freeplay {

/// Diagonal of the box about a body's origin, its centre of mass and its frames [m]; 0 where they all are one point.
double extent(const Model& model, BodyId body);

/// Where a run went wrong.
struct Wreck {
  double t = 0.0;   ///< [s]
  double dt = 0.0;  ///< length of steps of one size [s]; 0 with error control, which takes as short ones as it needs
  int joint = -1;   ///< that went wrong; -1: none in particular
  std::span<const double> first_forces{};  ///< of springs and the like at the start of the run, by joint [N]
  std::string worker{};  ///< what put in the energy, where all moves faster than in machines: a sentence as below
};

/// Of inertias, masses, lengths, moduli and stiffnesses of contacts, gravity, motions and efforts of drivers, loads,
/// springs and dampers that one which is farthest outside of what machines have, else `worker`, else a jump of a
/// driver's speed shortly before, else the step, as a sentence without full stop: "inertia of 'coupler' is 250 kg m^2
/// for a mass of 0.21 kg: its radius of gyration would be 34 m". Empty when all are inside. `e` is evaluated where the
/// run stands.
[[gnu::cold]] std::string likely_cause(const System& system, const Evaluation& e, const Wreck& wreck);

}  // namespace freeplay
