// Velocities at the start of a run.
#pragma once

#include <span>
#include <vector>

#include "assembly/closed_mechanism.h"

namespace freeplay {

/// A joint whose start speed [rad/s or m/s], or a body whose start velocity, follows from nothing but least kinetic
/// energy. Bodies are those whose motion no listed joint gives, as between joints without a coordinate.
struct ChosenSpeed {
  int joint = -1;              ///< index into Model::joints, or -1
  int body = -1;               ///< index into Model::bodies, or -1
  double speed = 0.0;          ///< of the joint; of the body's centre of mass [m/s], 0 where the file gives it
  double angular_speed = 0.0;  ///< of the body [rad/s], 0 likewise
};

/// Finds the velocities of an assembled mechanism, each of these as far as those before allow:
///   1. constraints, drivers, `speeds` and relative velocities that a `clearance` block gives hold exactly;
///   2. velocities that the file gives bodies are changed as little as possible in kinetic energy (in m and rad where
///      the mass says nothing): not at all where 1 allows it;
///   3. journals rest in bearings whose block gives no velocity;
///   4. bodies move with as little kinetic energy as possible.
/// `mass` is the diagonal of M. Returns the joints and bodies whose speed 4 decides, unless it is zero, where the model
/// has no more than 200 velocities. Throws Error{input} "assembly-failed" when 1 contradicts itself. Large models
/// (most_dense_columns) take 1 and 3 as one, and change all velocities least.
std::vector<ChosenSpeed> solve_velocities(ClosedMechanism& mechanism, std::span<const double> mass);

}  // namespace freeplay
