// Velocities at the start of a run.
#pragma once

#include <span>
#include <vector>

#include "assembly/closed_mechanism.h"

namespace freeplay {

/// A joint whose start speed [rad/s or m/s] follows from nothing but least kinetic energy.
struct ChosenSpeed {
  int joint = 0;
  double speed = 0.0;
};

/// Finds the velocities of an assembled mechanism, each of these as far as those before allow:
///   1. constraints, drivers, `speeds` and relative velocities that a `clearance` block gives hold exactly;
///   2. velocities that the file gives bodies are changed as little as possible in kinetic energy (in m and rad where
///      the mass says nothing): not at all where 1 allows it;
///   3. journals rest in bearings whose block gives no velocity;
///   4. bodies move with as little kinetic energy as possible.
/// `mass` is the diagonal of M. Returns the joints whose speed 4 decides, unless it is zero, where the model has no
/// more than 200 velocities. Throws Error{input} "assembly-failed" when 1 contradicts itself. Large models
/// (most_dense_columns) take 1 and 3 as one, and change all velocities least.
std::vector<ChosenSpeed> solve_velocities(ClosedMechanism& mechanism, std::span<const double> mass);

}  // namespace freeplay
