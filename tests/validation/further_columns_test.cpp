// Accelerations, work by element and columns that formulas give, against closed forms.
#include "run_model.h"

namespace freeplay::test::further_columns {
namespace {

/// A rod of 0.5 m on a pin that a driver turns by phi = 2 t + t^3, with a frame at its end and one on a driven train.
std::string turning(const std::string& output) {
  return "freeplay: 1\n"
         "bodies: {rod: {mass: 2, inertia: 0.1, com: [0.25, 0], frames: {tip: [0.5, 0.1]}}}\n"
         "joints: {pin: {type: revolute, between: [ground, rod]}}\n"
         "drivers: {motor: {joint: pin, kind: angle, value: 2*t + t^3}}\n"
         "simulation: {end: 1, step: 1 ms, output: {interval: 0.1, frames: [rod/tip], " +
         output + "}}\n";
}

TEST(FurtherColumns, AccelerationsAreThoseOfTheMotion) {
  const ModelRun run(turning("channels: [\"*\", \"body.*.ax\", body.rod.ay, \"*.alpha\", frame.rod/tip.ay]"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const double t = run.at(row, "time"), phi = 2.0 * t + t * t * t, w = 2.0 + 3.0 * t * t, a = 6.0 * t;
    const auto second = [&](double x, double y, bool along_y) {
      const double c = std::cos(phi), s = std::sin(phi), X = c * x - s * y, Y = s * x + c * y;
      return along_y ? a * X - w * w * Y : -a * Y - w * w * X;
    };
    EXPECT_NEAR(run.at(row, "body.rod.ax"), second(0.25, 0.0, false), 1e-10);
    EXPECT_NEAR(run.at(row, "body.rod.ay"), second(0.25, 0.0, true), 1e-10);
    EXPECT_NEAR(run.at(row, "body.rod.alpha"), a, 1e-10);
    EXPECT_NEAR(run.at(row, "frame.rod/tip.ay"), second(0.5, 0.1, true), 1e-10);
    EXPECT_NEAR(run.at(row, "frame.rod/tip.alpha"), a, 1e-10);
  }
  EXPECT_THROW(run.at(0, "frame.rod/tip.ax"), std::runtime_error);
}

// A free body in space, spinning about its axis of symmetry under gravity; and a rod that swings from a ball joint.
TEST(FurtherColumns, AccelerationsInSpaceObeyNewtonAndEuler) {
  const ModelRun run(
      "freeplay: 1\nspace: spatial\ngravity: [0, 0, -9.81]\n"
      "bodies: {rod: {mass: 2, inertia: [0.1, 0.1, 0.02], com: [0, 0.3, 0], velocity: {angular: [1, 0.5, 2]}}}\n"
      "joints: {ball: {type: spherical, between: [ground, rod]}}\n"
      "simulation: {end: 1, accuracy: 1e-7, output: {interval: 0.01, channels: [\"*\", body.rod.ax, body.rod.az,"
      " body.rod.alphax, body.rod.alphaz]}}\n");
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    EXPECT_NEAR(2.0 * run.at(row, "body.rod.ax"), run.at(row, "joint.ball.fx"), 1e-9);
    EXPECT_NEAR(2.0 * run.at(row, "body.rod.az"), run.at(row, "joint.ball.fz") - 2.0 * 9.81, 1e-9);
  }
  // Angular acceleration is the slope of the angular velocity.
  const double h = 0.01, slope = (run.at(51, "body.rod.wx") - run.at(49, "body.rod.wx")) / (2.0 * h);
  EXPECT_GT(std::abs(slope), 1.0);
  EXPECT_NEAR(run.at(50, "body.rod.alphax"), slope, 0.01 * std::abs(slope));
}

TEST(FurtherColumns, DefaultColumnsStayAsTheyWere) {
  const ModelRun run(turning("channels: [\"*\", \"body.*\", \"body.rod.*\"]"));
  EXPECT_THROW(run.at(0, "body.rod.ax"), std::runtime_error);
}

// A damped mass on a spring: the spring's work is what it gave of its store, less what its damper took.
TEST(FurtherColumns, WorkIsByElement) {
  const ModelRun run(
      "freeplay: 1\nbodies: {sled: {mass: 2, inertia: 1}}\n"
      "joints: {rail: {type: prismatic, between: [ground, sled]}}\n"
      "forces:\n  tie: {type: spring-damper, between: [ground, sled], free_length: 1, stiffness: 50, damping: 3}\n"
      "  push: {type: force, at: sled, value: [\"-2 N*s/m*body.sled.vx\", 0]}\n"
      "initial: {joints: {rail: 1.5}}\n"
      "simulation: {end: 1, accuracy: 1e-8, output: {interval: 0.1, channels: [\"*\", \"*.work\", force.tie.loss]}}\n");
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const double work = run.at(row, "force.tie.work"), loss = run.at(row, "force.tie.loss");
    EXPECT_NEAR(run.at(row, "force.push.work"), run.at(row, "energy.work"), 1e-12);
    EXPECT_NEAR(loss, run.at(row, "energy.dissipated"), 1e-12);
    EXPECT_NEAR(work, 6.25 - run.at(row, "energy.potential") - loss, 1e-9);
    EXPECT_NEAR(run.at(row, "energy.kinetic"), work + run.at(row, "force.push.work"), 1e-6);
    EXPECT_NEAR(1.5 * run.at(row, "force.push.work"), -loss, 1e-6);  // dampers of 2 and 3 N s/m take parts like that
  }
}

TEST(FurtherColumns, AFormulaIsAColumnAndMayEndARun) {
  const std::string text = turning(
      "columns: {lift: \"frame.rod/tip.y + 1 mm*t/(1 s)\", power: driver.motor.torque*joint.pin.speed, pull: "
      "\"2*body.rod.ax\"}");
  const ModelRun run(text);
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    EXPECT_EQ(run.at(row, "output.lift"), run.at(row, "frame.rod/tip.y") + 1e-3 * run.at(row, "time"));
    EXPECT_EQ(run.at(row, "output.power"), run.at(row, "driver.motor.power"));
    EXPECT_EQ(run.at(row, "output.pull"), 2.0 * run.at(row, "body.rod.ax"));
  }
  const ModelRun stopped(replaced(text, "simulation: {", "simulation: {stop: [{channel: output.power, above: 4 W}], "));
  EXPECT_EQ(stopped.outcome().status, RunStatus::stopped);
  EXPECT_GT(stopped.last("output.power"), 4.0);
}

TEST(FurtherColumns, AFormulaIsCheckedWithItsPlace) {
  const auto report = [&](const std::string& columns) {
    try {
      load(turning("columns: {" + columns + "}"));
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(report("lift: body.rood.y").find("did you mean 'body.rod.y'"), std::string::npos)
      << report("lift: body.rood.y");
  EXPECT_NE(report("lift: body.rod.y + body.rod.vy").find("dimension-mismatch"), std::string::npos);
  EXPECT_NE(report("\"a b\": body.rod.y").find("bad-name"), std::string::npos);
  EXPECT_EQ(report("lift: body.rod.y + joint.pin.fx*0 m/N"), "");
}

}  // namespace
}  // namespace freeplay::test::further_columns
