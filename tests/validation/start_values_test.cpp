#include "run_model.h"

namespace freeplay::test {
namespace {

// A rod of 1 m thrown with a velocity that its pin forbids: the least change in kinetic energy, then accelerations and
// reactions. Closed form by the mass-weighted projector; 13 digits are given.
TEST(StartValues, ForbiddenVelocityIsChangedLeastInKineticEnergy) {
  const ModelRun run(
      "freeplay: 1\ngravity: [0, -9.81]\n"
      "bodies:\n"
      "  rod: {mass: 1, inertia: 1/12, frames: {pin: [-0.5, 0]}, velocity: {linear: [0.3, -0.2], angular: 1}}\n"
      "joints: {pivot: {type: revolute, between: [ground, rod/pin]}}\n"
      "initial: {joints: {pivot: -0.09732897742034}}\n"
      "simulation: {end: 1 ms, step: 1 ms}\n");
  EXPECT_NEAR(run.at(0, "body.rod.x"), 0.4976336364567, 1e-12);
  EXPECT_NEAR(run.at(0, "body.rod.y"), -0.04858769254551, 1e-12);
  EXPECT_NEAR(run.at(0, "body.rod.vx"), -0.0002357114604919, 1e-12);
  EXPECT_NEAR(run.at(0, "body.rod.vy"), -0.002414149450076, 1e-12);
  EXPECT_NEAR(run.at(0, "body.rod.omega"), -0.004851258583052, 1e-12);
  EXPECT_NEAR(run.at(0, "joint.pivot.fx"), -0.7115958595439, 1e-11);
  EXPECT_NEAR(run.at(0, "joint.pivot.fy"), 2.5219784241, 1e-10);
}

}  // namespace
}  // namespace freeplay::test
