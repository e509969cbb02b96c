#include <cmath>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::ModelRun;

/// Two wheels on ground and a rack that slides along x.
std::string wheels(const std::string& gear, const std::string& more) {
  return "freeplay: 1\n"
         "bodies:\n"
         "  ground: {frames: {hub: [1, 0], rail: [0, 1]}}\n"
         "  big: {mass: 2, inertia: 0.5}\n"
         "  small: {mass: 1, inertia: 0.2}\n"
         "  rack: {mass: 3, inertia: 1}\n"
         "joints:\n"
         "  G: {type: gear, " +
         gear +
         "}\n"
         "  B: {type: revolute, between: [ground, big]}\n"
         "  S: {type: revolute, between: [ground/hub, small]}\n"
         "  R: {type: prismatic, between: [ground/rail, rack]}\n"
         "simulation: {end: 0.5 s, step: 1 ms}\n" +
         more;
}

TEST(GearMotion, TransmitsATorqueByItsRatio) {
  const ModelRun run(wheels("of: [B, S], ratio: -2", "forces: {push: {type: torque, on: big, value: 3}}\n"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  // (0.5 + (-2)^2 0.2) alpha = 3; the small wheel needs 0.2 (-2 alpha).
  const double alpha = 3.0 / 1.3;
  EXPECT_NEAR(run.last("joint.B.angle"), 0.5 * alpha * 0.25, 1e-9);
  EXPECT_NEAR(run.last("joint.S.angle"), -alpha * 0.25, 1e-9);
  EXPECT_NEAR(run.last("joint.G.torque"), -0.4 * alpha, 1e-9);
  EXPECT_NEAR(run.last("joint.G.fx"), 0.0, 1e-12);
  EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-9);
  EXPECT_EQ(run.start().facts.actual.constraints, 7);
  EXPECT_EQ(run.start().facts.actual.dof, 2);
  EXPECT_EQ(run.start().facts.joints, 4);
}

TEST(GearMotion, PushesARack) {
  const ModelRun run(wheels("of: [S, R], ratio: 50 mm", "forces: {push: {type: torque, on: small, value: 1}}\n"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  // (0.2 + 0.05^2 3) alpha = 1, the rack is pushed with 3 (0.05 alpha) along x.
  const double alpha = 1.0 / 0.2075;
  EXPECT_NEAR(run.last("joint.R.position"), 0.05 * 0.5 * alpha * 0.25, 1e-9);
  EXPECT_NEAR(run.last("joint.G.fx"), 0.15 * alpha, 1e-9);
  EXPECT_NEAR(run.last("joint.G.fy"), 0.0, 1e-9);
  EXPECT_NEAR(run.last("joint.G.torque"), 0.0, 1e-9);
}

TEST(GearMotion, KeepsTheOffsetOfTheStart) {
  const ModelRun run(wheels("of: [B, S], ratio: 3",
                            "initial: {joints: {B: 10 deg, S: 50 deg}}\n"
                            "drivers: {motor: {joint: B, kind: velocity, value: 2}}\n"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  EXPECT_NEAR(run.at(0, "joint.S.angle"), 50.0 * M_PI / 180.0, 1e-12);
  EXPECT_NEAR(run.last("joint.S.angle"), 50.0 * M_PI / 180.0 + 3.0, 1e-10);
}

TEST(GearMotion, AssemblesToAGivenOffset) {
  const ModelRun run(wheels("of: [B, S], ratio: 3, offset: 90 deg", "initial: {joints: {B: 10 deg}}\n"));
  EXPECT_NEAR(run.at(0, "joint.S.angle"), 120.0 * M_PI / 180.0, 1e-12);
}

TEST(GearMotion, RowIsDerivativeOnMovingJoints) {
  // A pin on a slide: three bodies share the row, and the slide's line turns with the first wheel.
  const std::string text =
      "freeplay: 1\n"
      "bodies:\n"
      "  arm: {mass: 1, inertia: 1}\n"
      "  block: {mass: 1, inertia: 1, com: [0.1, 0.2]}\n"
      "  wheel: {mass: 1, inertia: 1}\n"
      "joints:\n"
      "  A: {type: revolute, between: [ground, arm]}\n"
      "  L: {type: point-on-line, between: [arm, block]}\n"
      "  W: {type: revolute, between: [block, wheel]}\n"
      "  G: {type: gear, of: [L, W], ratio: 2 rad/m}\n";
  const std::unique_ptr<Model> model = test::load(text);
  const System system(*model);
  Evaluation e(system);
  const auto row = static_cast<std::size_t>(system.layout().rows(3).offset);
  const std::size_t nv = 9;
  const auto at = [&](double t, std::vector<double>* rate) {
    State state(system.layout(), 0);
    for (std::size_t i = 0; i < nv; ++i) {
      const double k = static_cast<double>(i) + 1.0;
      state.q()[i] = 0.1 * k + 0.3 / k * t + 0.05 * k * t * t;
      state.v()[i] = 0.3 / k + 0.1 * k * t;
    }
    EXPECT_TRUE(system.evaluate(point(state), term_position | term_velocity | term_acceleration, e));
    rate->assign(static_cast<std::size_t>(system.layout().nc()), 0.0);
    system.jacobian().multiply(e.jacobian, state.v(), *rate);
    return e.phi[row];
  };
  const double h = 1e-5;
  std::vector<double> before, now, after;
  const double low = at(-h, &before), high = at(h, &after);
  at(0.0, &now);
  EXPECT_NEAR(now[row], (high - low) / (2.0 * h), 1e-8);
  std::vector<double> a(nv), product(before.size());
  for (std::size_t i = 0; i < nv; ++i) a[i] = 0.1 * (static_cast<double>(i) + 1.0);
  system.jacobian().multiply(e.jacobian, a, product);
  EXPECT_NEAR(product[row] - e.gamma[row], (after[row] - before[row]) / (2.0 * h), 1e-7);
}

}  // namespace
}  // namespace freeplay
