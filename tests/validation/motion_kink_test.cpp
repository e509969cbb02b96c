// Prescribed motions with kinks: steps end there, a jump of the speed is an impulse whose work is booked.
#include "run_model.h"

namespace freeplay::test {
namespace {

// A cart of 2 kg on a guide starts to move at 1 m/s at once; a rod of 1 kg and 1 m hangs from it, without gravity.
// About its pin the rod has no angular momentum, before and behind: J w + m l (v + l w) = 0, l = 0.5 m, J = 1/12 kg
// m^2, hence w = -1.5 rad/s, and the work is what both have then, 1 + 0.125 J. Later nothing acts.
std::string cart(const std::string& motion) {
  return "freeplay: 1\n"
         "bodies:\n"
         "  cart: {mass: 2, inertia: 1}\n"
         "  rod: {mass: 1, inertia: 1/12, com: [0.5, 0], pose: {angle: -90 deg}}\n"
         "joints:\n"
         "  guide: {type: prismatic, between: [ground, cart]}\n"
         "  pin: {type: revolute, between: [cart, rod]}\n"
         "drivers: {motor: {joint: guide, kind: position, " +
         motion +
         "}}\n"
         "initial: {joints: {pin: -90 deg}, speeds: {pin: 0}}\n"
         "simulation: {end: 1, accuracy: 1e-9, output: {interval: 0.1}}\n";
}

BuildOptions by(const char* integrator) {
  BuildOptions options;
  options.integrator = integrator;
  return options;
}

TEST(MotionKink, AJumpOfTheSpeedIsAnImpulse) {
  for (const char* motion : {"value: 'max(0, t - 0.3)'", "value: '(abs(t - 0.3) + t - 0.3)/2'",
                             "table: {points: [[0, 0], [0.3, 0], [1.3, 1]], interpolation: linear}"}) {
    for (const char* integrator : {"dopri5", "bathe", "newmark", "hht", "generalized-alpha"}) {
      const ModelRun run(cart(motion), by(integrator));
      ASSERT_EQ(run.outcome().status, RunStatus::completed) << integrator << ": " << run.outcome().reason;
      // The impulse is exact; behind it the methods of order 2 err by their own measure.
      const double error = std::string(integrator) == "dopri5" ? 1e-9 : 5e-7;
      EXPECT_NEAR(run.at(3, "energy.work"), 1.125, error) << motion << " " << integrator;
      EXPECT_NEAR(run.at(3, "body.rod.omega"), -1.5, error) << motion << " " << integrator;
      EXPECT_NEAR(run.last("body.rod.angle"), std::acos(0.0) * -1.0 - 1.5 * 0.7, error) << motion << " " << integrator;
      EXPECT_NEAR(run.last("energy.residual"), 0.0, error) << motion << " " << integrator;
      EXPECT_NEAR(run.last("body.cart.x"), 0.7, 1e-12) << motion << " " << integrator;
      EXPECT_LT(run.outcome().rejected, 5) << motion << " " << integrator;
    }
  }
}

TEST(MotionKink, ARowAtACornerHasTheValuesAfterIt) {
  const ModelRun run(cart("value: 'max(0, t - 0.3)'"));
  ASSERT_EQ(run.rows(), 11u);
  EXPECT_DOUBLE_EQ(run.at(3, "time"), 0.3);
  EXPECT_NEAR(run.at(2, "body.cart.vx"), 0.0, 1e-12);
  EXPECT_NEAR(run.at(3, "body.cart.vx"), 1.0, 1e-12);
  EXPECT_NEAR(run.at(3, "body.rod.omega"), -1.5, 1e-9);
}

TEST(MotionKink, AJumpOfTheAccelerationCostsNoRejectedSteps) {
  for (const char* integrator : {"dopri5", "bathe", "generalized-alpha"}) {
    const ModelRun run(cart("value: 'max(0, t - 0.3)^2'"), by(integrator));
    ASSERT_EQ(run.outcome().status, RunStatus::completed) << integrator << ": " << run.outcome().reason;
    EXPECT_LE(run.outcome().rejected, 1) << integrator;  // of the start
    EXPECT_NEAR(run.last("body.cart.vx"), 1.4, 1e-9) << integrator;
    EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-6) << integrator;
  }
}

TEST(MotionKink, EveryEndOfARepeatedTableIsMet) {
  const ModelRun run(cart("table: {points: [[0, 0], [0.1, 0.02], [0.2, 0]], interpolation: linear, outside: repeat}"));
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  EXPECT_LT(run.outcome().rejected, 3);
  // Speeds of 0.2 and -0.2 m/s in turn; the rod stays close to the vertical, where every impulse turns its rate about.
  for (std::size_t row = 1; row + 1 < run.rows(); ++row) {
    EXPECT_NEAR(run.at(row, "body.cart.vx"), row % 2 == 0 ? 0.2 : -0.2, 1e-9) << row;
    EXPECT_NEAR(run.at(row, "energy.residual"), 0.0, 1e-9) << row;
  }
}

// The side of a corner is a rounding of its time, in which a fast driver goes on.
TEST(MotionKink, ACornerOfTheSpeedLateInTimeIsNoJumpOfThePosition) {
  const std::string text =
      "freeplay: 1\nbodies: {fan: {mass: 1, inertia: 0.01}}\njoints: {hub: {type: revolute, between: [ground, fan]}}\n"
      "drivers: {motor: {joint: hub, kind: velocity, table: {points: [[36000.1, 0], [36001.3, 600], [36004.7, 600], "
      "[36006.1, 20]], unit: rad/s, interpolation: linear}}}\n"
      "simulation: {start: 36000.1 s, end: 36006.1 s, accuracy: 1e-6, output: {interval: 0.1}}\n";
  const ModelRun run(text);
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  EXPECT_NEAR(run.last("joint.hub.speed"), 20.0, 1e-8);
  EXPECT_NEAR(run.last("joint.hub.angle"), 0.5 * 600 * 1.2 + 600 * 3.4 + 0.5 * 620 * 1.4, 1e-6);
}

TEST(MotionKink, AJumpOfThePositionEndsTheRunAndNamesTheDriver) {
  for (const std::string motion : {"table: {points: [[0, 0], [0.2, 0.1]], interpolation: linear, outside: repeat}",
                                   "value: '1e-4*sign(t - 0.2)'"}) {
    // Also steps of one size, to whose ends the jump comes or not.
    for (const char* steps : {"accuracy: 1e-9", "step: 1e-3", "step: 0.7e-3"}) {
      const ModelRun run(replaced(cart(motion), "accuracy: 1e-9", steps));
      EXPECT_EQ(run.outcome().status, RunStatus::failed) << motion << " " << steps;
      EXPECT_EQ(run.outcome().exit_code, 4);
      EXPECT_EQ(run.outcome().reason, "t = 0.2 s: driver 'motor': the prescribed position jumps; no motion follows it");
    }
  }
}

// A table from 0 to 360 degrees that repeats turns a body that it drives on; between bodies of which one hangs free the
// turns of the joint count.
TEST(MotionKink, AJumpByAWholeTurnIsNoneOfADrivenBody) {
  const std::string text =
      "freeplay: 1\n"
      "bodies: {swing: {mass: 1, inertia: 1}, arm: {mass: 2, inertia: 1, frames: {end: [0.1, 0]}}}\n"
      "joints: {hang: {type: revolute, between: [ground, swing]}, pin: {type: revolute, between: [ground, arm]}}\n"
      "drivers: {motor: {joint: pin, kind: angle, table: {points: [[0, 0], [0.2, 360 deg]], interpolation: linear, "
      "outside: repeat}}}\n"
      "initial: {joints: {hang: 0}, speeds: {hang: 0}}\n"
      "simulation: {end: 1.05, accuracy: 1e-6, output: {interval: 0.05}}\n";
  const double turn = 2.0 * std::acos(-1.0);
  for (const char* steps : {"accuracy: 1e-6", "step: 1e-3", "step: 0.7e-3"}) {
    const ModelRun run(replaced(text, "accuracy: 1e-6", steps));
    ASSERT_EQ(run.outcome().status, RunStatus::completed) << steps << " " << run.outcome().reason;
    EXPECT_NEAR(run.last("joint.pin.angle"), 5.25 * turn, 1e-9) << steps;
    EXPECT_NEAR(run.last("joint.pin.speed"), 5.0 * turn, 1e-9) << steps;
    const ModelRun other(replaced(replaced(text, "[ground, arm]", "[swing, arm]"), "accuracy: 1e-6", steps));
    EXPECT_EQ(other.outcome().reason, "t = 0.2 s: driver 'motor': the prescribed position jumps; no motion follows it");
  }
}

}  // namespace
}  // namespace freeplay::test
