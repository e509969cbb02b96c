// Forces that depend on the motion: orders, kinks and energy against closed forms.
#include "run_model.h"

namespace freeplay::test {
namespace {

/// A mass of 2 kg on a rail along x, pushed by `value` [N].
std::string sled(const std::string& value, double x, double v, const std::string& simulation) {
  return "freeplay: 1\n"
         "bodies: {sled: {mass: 2, inertia: 1}}\n"
         "joints: {rail: {type: prismatic, between: [ground, sled]}}\n"
         "forces: {push: {type: force, at: sled, value: [\"" +
         value + "\", 0]}}\ninitial: {joints: {rail: " + number(x) + "}, speeds: {rail: " + number(v) +
         "}}\nsimulation: {" + simulation + "}\n";
}

constexpr const char* quadratic = "-3 N*s^2/m^2*body.sled.vx*abs(body.sled.vx)";

/// Speed and place at time t of the sled that quadratic drag stops: 2 v' = -3 v^2.
struct Dragged {
  double t;
  double v() const { return 4.0 / (1.0 + 1.5 * 4.0 * t); }
  double x() const { return std::log(1.0 + 1.5 * 4.0 * t) / 1.5; }
};

struct FixedMethod {
  const char* integrator;
  int order;
  double step;
};
void PrintTo(const FixedMethod& method, std::ostream* out) { *out << method.integrator; }
class MotionForceOrder : public ::testing::TestWithParam<FixedMethod> {};

TEST_P(MotionForceOrder, IsThatOfTheMethod) {
  std::vector<double> errors;
  for (double step = GetParam().step; errors.size() < 3; step *= 0.5) {
    const ModelRun run(sled(quadratic, 0.0, 4.0,
                            "end: 0.5, step: " + number(step) + ", integrator: {type: " + GetParam().integrator +
                                "}, output: {interval: 0.1}"));
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    const Dragged at{0.5};
    errors.push_back(std::hypot(run.last("body.sled.vx") - at.v(), run.last("body.sled.x") - at.x()));
  }
  record("error", errors[2]);
  EXPECT_GE(order(errors[1], errors[2]), GetParam().order - 0.2);
}
INSTANTIATE_TEST_SUITE_P(Methods, MotionForceOrder,
                         ::testing::Values(FixedMethod{"bathe", 2, 0.01}, FixedMethod{"newmark", 2, 0.01},
                                           FixedMethod{"hht", 2, 0.01}, FixedMethod{"generalized-alpha", 2, 0.01}));

TEST(MotionForce, FollowsAnAccuracyWithEveryMethod) {
  for (const char* integrator : {"bathe", "dopri5", "verner6", "verner7"}) {
    const ModelRun run(
        sled(quadratic, 0.0, 4.0,
             std::string("end: 0.5, accuracy: 1e-8, integrator: {type: ") + integrator + "}, output: {interval: 0.1}"));
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    const Dragged at{0.5};
    EXPECT_NEAR(run.last("body.sled.x"), at.x(), 1e-8) << integrator;
    EXPECT_NEAR(run.last("body.sled.vx"), at.v(), 1e-7) << integrator;
    // Work of the force: what kinetic energy has lost.
    EXPECT_NEAR(run.last("energy.work"), at.v() * at.v() - 16.0, 1e-6) << integrator;
    EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-6) << integrator;
  }
}

// (50 + 10 |x|) x swings from A to -A and back in four times the integral of 1/v: with x = A sin(p) it is smooth.
TEST(MotionForce, ASpringThatGrowsStifferHasItsPeriod) {
  const double a = 0.8, mass = 2.0;
  const auto potential = [](double x) { return 25.0 * x * x + 10.0 / 3.0 * x * x * std::abs(x); };
  const auto integrand = [&](double p) {
    const double x = a * std::sin(p), left = potential(a) - potential(x);
    const double c = a * std::cos(p);
    return std::sqrt(c * c > 1e-7 ? mass * c * c / 2.0 / left : mass / (50.0 + 10.0 * a));
  };
  double quarter = 0.0;
  const int panels = 2000;
  for (int i = 0; i < panels; ++i) {
    const double h = 0.5 * M_PI / panels, p = i * h;
    quarter += h / 6.0 * (integrand(p) + 4.0 * integrand(p + 0.5 * h) + integrand(p + h));
  }
  const ModelRun run(sled("-(50 N/m + 10 N/m^2*abs(joint.rail.position))*joint.rail.position", a, 0.0,
                          "end: " + number(4.0 * quarter) + ", accuracy: 1e-9, output: {interval: 0.1}"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  EXPECT_NEAR(run.last("joint.rail.position"), a, 1e-8);
  EXPECT_NEAR(run.last("joint.rail.speed"), 0.0, 1e-7);
  EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-8);
}

// A force of -6 N where x > 1 m, from x = 0 at 3 m/s: the jump is at 1/3 s, and the sled comes back at -3 m/s.
TEST(MotionForce, StepsEndWhereAFormulaJumps) {
  for (const char* integrator : {"bathe", "dopri5", "verner7"}) {
    const ModelRun run(
        sled("-if(body.sled.x > 1 m, 6 N, 0)", 0.0, 3.0,
             std::string("end: 3, accuracy: 1e-7, integrator: {type: ") + integrator + "}, output: {interval: 0.5}"));
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    const double beyond = 2.0 * 3.0 / 3.0, back = 3.0 - 1.0 / 3.0 - beyond;
    EXPECT_NEAR(run.last("body.sled.vx"), -3.0, 1e-9) << integrator;
    EXPECT_NEAR(run.last("body.sled.x"), 1.0 - 3.0 * back, 1e-9) << integrator;
    EXPECT_LT(run.outcome().steps + run.outcome().rejected, 120) << integrator;
    EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-9) << integrator;
  }
}

// In steps of one size a formula keeps its form to the end of the step: an error of the order of the step.
TEST(MotionForce, AJumpDoesNotStopFixedSteps) {
  const ModelRun run(sled("-if(body.sled.x > 1 m, 6 N, 0)", 0.0, 3.0, "end: 3, step: 1 ms, output: {interval: 0.5}"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  EXPECT_NEAR(run.last("body.sled.vx"), -3.0, 3.0 * 3e-3);
}

// What acts against the motion alone does its work one way: 6 N over the 2 m of the way forth of x = sin(t).
TEST(MotionForce, ActsAgainstTheMotionOneWay) {
  const std::string text =
      "freeplay: 1\n"
      "bodies: {ram: {mass: 2, inertia: 1}}\n"
      "joints: {slide: {type: prismatic, between: [ground, ram]}}\n"
      "drivers: {crank: {joint: slide, kind: position, value: -cos(t)}}\n"
      "forces: {cut: {type: force, at: ram, value: [\"-6 N*if(body.ram.vx > 0, 1, 0)\", 0]}}\n"
      "simulation: {end: 6.283185307179586, SIZE, output: {interval: 0.1}}\n";
  const ModelRun accurate(replaced(text, "SIZE", "accuracy: 1e-7"));
  ASSERT_EQ(accurate.outcome().exit_code, 0) << accurate.outcome().reason;
  EXPECT_NEAR(accurate.last("energy.work"), 0.0, 1e-6);
  EXPECT_NEAR(accurate.at(10, "driver.crank.force"), 2.0 * std::cos(1.0) + 6.0, 1e-9);
  EXPECT_NEAR(accurate.at(50, "driver.crank.force"), 2.0 * std::cos(5.0), 1e-9);
  const ModelRun fixed(replaced(text, "SIZE", "step: 1 ms"));
  ASSERT_EQ(fixed.outcome().exit_code, 0) << fixed.outcome().reason;
  EXPECT_NEAR(fixed.at(10, "driver.crank.force"), 2.0 * std::cos(1.0) + 6.0, 1e-9);
  EXPECT_NEAR(fixed.at(50, "driver.crank.force"), 2.0 * std::cos(5.0), 1e-9);
}

// What rests but for rounding, and what holds a body still, must not be hunted for ever.
TEST(MotionForce, RestDoesNotMakeEvents) {
  const ModelRun rest(sled("-3 N*s/m*body.sled.vx - 5 N*sign(body.sled.vy)", 0.0, 4.0,
                           "end: 0.5, accuracy: 1e-8, output: {interval: 0.1}"));
  ASSERT_EQ(rest.outcome().exit_code, 0) << rest.outcome().reason;
  EXPECT_LT(rest.outcome().steps, 200);
  const ModelRun held(sled("-5 N*sign(body.sled.vx)", 0.0, 1.0, "end: 1, accuracy: 1e-8, output: {interval: 0.1}"));
  EXPECT_EQ(held.outcome().exit_code, 4);
  EXPECT_NE(held.outcome().reason.find("the formula of force 'push' changes its form without end"), std::string::npos)
      << held.outcome().reason;
}

// A motor that brakes with -0.2 w on an inertia of 0.05 kg m^2, and one that pulls a second disc after the first.
TEST(MotionForce, IsTheEffortOfADriver) {
  const std::string text =
      "freeplay: 1\n"
      "bodies: {disc: {mass: 1, inertia: 0.05}, wheel: {mass: 1, inertia: 0.5}}\n"
      "joints:\n"
      "  hub: {type: revolute, between: [ground, disc]}\n"
      "  pin: {type: revolute, between: [ground, wheel]}\n"
      "drivers:\n"
      "  brake: {joint: hub, kind: torque, value: \"-0.2 N*m*s*joint.hub.speed\"}\n"
      "  pull: {joint: pin, kind: torque, value: \"3 N*m*(body.disc.angle - joint.pin.angle)\"}\n"
      "initial: {speeds: {hub: 20, pin: 0}}\n"
      "simulation: {end: 1, STEPS, output: {interval: 0.25}}\n";
  // p'' + 6 p = 6 h, h = 5 (1 - exp(-4 t)): p = 5 - 30/22 exp(-4 t) + a cos(w t) + b sin(w t).
  const double w = std::sqrt(6.0), a = 30.0 / 22.0 - 5.0, b = -4.0 * 30.0 / 22.0 / w;
  const auto wheel = [&](double t) {
    return 5.0 - 30.0 / 22.0 * std::exp(-4.0 * t) + a * std::cos(w * t) + b * std::sin(w * t);
  };
  for (const char* steps : {"accuracy: 1e-8", "accuracy: 1e-8, integrator: {type: verner7}"}) {
    const ModelRun run(replaced(text, "STEPS", steps));
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    EXPECT_NEAR(run.last("joint.hub.speed"), 20.0 * std::exp(-4.0), 1e-6) << steps;
    EXPECT_NEAR(run.last("joint.pin.angle"), wheel(1.0), 1e-6) << steps;
    EXPECT_NEAR(run.last("driver.brake.torque"), -0.2 * run.last("joint.hub.speed"), 1e-12) << steps;
    EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-5) << steps;
  }
  const ModelRun coarse(replaced(text, "STEPS", "step: 4 ms")), fine(replaced(text, "STEPS", "step: 2 ms"));
  const auto off = [&](const ModelRun& run) {
    return std::hypot(run.last("joint.hub.speed") - 20.0 * std::exp(-4.0), run.last("joint.pin.angle") - wheel(1.0));
  };
  EXPECT_GE(order(off(coarse), off(fine)), 1.8);
}

TEST(MotionForce, SaysWhereAFormulaHasNoValue) {
  const ModelRun run(
      sled("-sqrt(1 - body.sled.x/1 m)*1 N", 0.0, 3.0, "end: 1, accuracy: 1e-6, output: {interval: 0.1}"));
  EXPECT_EQ(run.outcome().exit_code, 4);
  EXPECT_NE(run.outcome().reason.find("force 'push': square root of a negative number [bad-expression]"),
            std::string::npos)
      << run.outcome().reason;
}

}  // namespace
}  // namespace freeplay::test
