#include <cmath>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::ModelRun;

/// A mass on a rail along x.
std::string sled(const std::string& more) {
  return "freeplay: 1\n"
         "bodies: {sled: {mass: 2, inertia: 1}}\n"
         "joints: {rail: {type: prismatic, between: [ground, sled]}}\n"
         "initial: {joints: {rail: 0.3}}\n"
         "simulation: {end: 1 s, step: 1 ms}\n" +
         more;
}

TEST(ForceElement, ReportsAsAForceWithItsOwnChannels) {
  const ModelRun run(
      sled("forces:\n"
           "  push: {type: force, at: sled, value: [1, 0]}\n"
           "  band: {type: spring-damper, between: [ground, sled], stiffness: 50, damping: 3}\n"
           "  hub: {type: spring-damper, between: [ground, sled], kind: rotational}\n"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  std::vector<std::string> forces;
  for (const std::string& name : run.kept().names()) {
    if (name.starts_with("force.")) forces.push_back(name);
    EXPECT_FALSE(name.starts_with("joint.band")) << name;
  }
  EXPECT_EQ(forces, (std::vector<std::string>{"force.push.fx", "force.push.fy", "force.push.torque", "force.push.power",
                                              "force.band.fx", "force.band.fy", "force.band.torque", "force.band.power",
                                              "force.band.length", "force.hub.fx", "force.hub.fy", "force.hub.torque",
                                              "force.hub.power", "force.hub.angle"}));
  EXPECT_EQ(run.at(0, "force.band.fx"), -15.0);
  EXPECT_NEAR(run.at(0, "force.band.length"), 0.3, 1e-15);
  const double speed = run.last("joint.rail.speed");
  EXPECT_NEAR(run.last("force.band.power"), run.last("force.band.fx") * speed, 1e-12);
  EXPECT_EQ(run.start().facts.joints, 1);
}

TEST(ForceElement, SpringsStoreAndDampersDissipate) {
  const ModelRun run(
      sled("forces:\n"
           "  band: {type: spring-damper, between: [ground, sled], stiffness: 50, damping: 3, "
           "free_length: 0.1, preload: 2 N}\n"));
  // With a second point on the far side never reached: m x'' = -50 (x - 0.1) - 3 x' - 2 as long as x > 0.
  const double offset = 0.1 - 2.0 / 50.0, decay = 0.75, w = std::sqrt(25.0 - decay * decay), t = 0.3;
  const double swing = 0.3 - offset;
  const double x = offset + swing * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
  const std::size_t row = 300;
  EXPECT_NEAR(run.at(row, "joint.rail.position"), x, 1e-6);
  EXPECT_GT(run.last("energy.dissipated"), 0.1);
  EXPECT_NEAR(run.at(row, "energy.residual"), 0.0, 2e-5);  // powers are summed by the trapezoidal rule
}

TEST(ForceElement, MayBeWrittenAsAJoint) {
  const ModelRun run(
      "freeplay: 1\n"
      "bodies: {disc: {mass: 1, inertia: 0.05}}\n"
      "joints:\n"
      "  hub: {type: revolute, between: [ground, disc]}\n"
      "  bar: {type: spring-damper, kind: rotational, between: [ground, disc], stiffness: 5, free_angle: 20 deg}\n"
      "initial: {speeds: {hub: 200}}\n"
      "simulation: {end: 0.1 s, step: 0.1 ms}\n");
  // Swings through more than a turn: the torque counts turns. sqrt(5/0.05) = 10 rad/s.
  const double free = M_PI / 9.0, t = 0.1;
  EXPECT_NEAR(run.last("joint.bar.angle"), free - free * std::cos(10.0 * t) + 20.0 * std::sin(10.0 * t), 1e-4);
  EXPECT_EQ(run.last("joint.bar.angle"), run.last("joint.hub.angle"));
  EXPECT_NEAR(run.last("joint.bar.torque"), -5.0 * (run.last("joint.hub.angle") - free), 1e-9);
  EXPECT_EQ(run.start().facts.joints, 2);
}

TEST(DriverTable, MovesAJointAndIsIntegratedForASpeed) {
  const ModelRun run(
      "freeplay: 1\n"
      "bodies: {disc: {mass: 1, inertia: 0.05}, wheel: {mass: 1, inertia: 0.05}}\n"
      "joints:\n"
      "  hub: {type: revolute, between: [ground, disc]}\n"
      "  pin: {type: revolute, between: [ground, wheel]}\n"
      "drivers:\n"
      "  turn: {joint: hub, kind: angle, table: {points: [[0, 0], [0.5, 90 deg]], ends: clamped}}\n"
      "  spin: {joint: pin, kind: velocity, table: {points: [[-1, 0], [0, 2], [1, 6]], interpolation: linear}}\n"
      "initial: {joints: {pin: 0.3}}\n"
      "simulation: {end: 0.6 s, step: 1 ms}\n");
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  EXPECT_NEAR(run.last("joint.hub.angle"), M_PI / 2.0, 1e-12);
  EXPECT_NEAR(run.last("joint.hub.speed"), 0.0, 1e-12);
  EXPECT_NEAR(run.last("joint.pin.angle"), 0.3 + 2.0 * 0.6 + 2.0 * 0.36, 1e-12);
  EXPECT_NEAR(run.last("joint.pin.speed"), 2.0 + 4.0 * 0.6, 1e-11);
}

}  // namespace
}  // namespace freeplay
