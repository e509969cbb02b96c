#include "system/path_follower.h"

#include <cmath>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::load;
using test::mechanism;
using test::replaced;

/// An assembled model and the motions of its drivers.
struct Assembled {
  explicit Assembled(const std::string& text) : model(load(text)), system(*model), start(assemble(system)) {}

  std::vector<TimeValue> at(double t) {
    std::vector<TimeValue> values(model->drivers.size());
    EXPECT_TRUE(system.motions().evaluate(t, {values.data(), values.size()}, fault)) << fault.text;
    return values;
  }
  std::unique_ptr<Model> model;
  System system;
  Start start;
  MotionFault fault;
};

std::string id_of(const std::string& text) {
  try {
    const Assembled assembled(text);
  } catch (const Error& error) {
    return error.id();
  }
  return "";
}

/// Legs of a pin, a slide and a pin each, whose slides are driven.
std::string slides(const std::string& path, const std::string& more = "") {
  return "freeplay: 1\n"
         "bodies: {platform: {mass: 0.977161, inertia: 7.035559e-3}}\n"
         "templates:\n"
         "  leg:\n"
         "    parameters: {at: required}\n"
         "    bodies:\n"
         "      cylinder: {mass: 0.4, inertia: 1.2e-3, com: [80 mm, 0], pose: {angle: $at + pi}}\n"
         "      rod: {mass: 0.25, inertia: 7e-4, com: [-90 mm, 0]}\n"
         "    frames:\n"
         "      ground/A: {polar: [0.4, $at]}\n"
         "      platform/C: {polar: [0.11, $at]}\n"
         "    joints:\n"
         "      A: {type: revolute, between: [ground/A, cylinder]}\n"
         "      P: {type: prismatic, between: [cylinder, rod]}\n"
         "      C: {type: revolute, between: [rod, platform/C]}\n"
         "instances: {leg: {template: leg, count: 3, with: {at: 7*pi/6 + 2*pi*($i-1)/3}}}\n"
         "drivers:\n"
         "  circle: {inverse_kinematics: {frame: platform, path: {" +
         path + "}, joints: leg*.P}}\n" + more;
}
const std::string circle = "x: 0.05*cos(4*pi*t), y: 0.05*sin(4*pi*t), angle: 0.1";

std::string five_bar(const std::string& path) {
  return "freeplay: 1\n"
         "bodies:\n"
         "  ground: {frames: {A1: [-0.1, 0], A2: [0.1, 0]}}\n"
         "  crank1: {mass: 0.2, inertia: 4e-4, frames: {B: [0.15, 0]}, pose: {angle: 1.8}}\n"
         "  coupler1: {mass: 0.25, inertia: 9e-4, frames: {C: [0.2, 0]}, pose: {angle: 0.6}}\n"
         "  crank2: {mass: 0.2, inertia: 4e-4, frames: {B: [0.15, 0]}, pose: {angle: 1.2}}\n"
         "  coupler2: {mass: 0.25, inertia: 9e-4, frames: {C: [0.2, 0]}, pose: {angle: 2.4}}\n"
         "joints:\n"
         "  A1: {type: revolute, between: [ground/A1, crank1]}\n"
         "  B1: {type: revolute, between: [crank1/B, coupler1]}\n"
         "  A2: {type: revolute, between: [ground/A2, crank2]}\n"
         "  B2: {type: revolute, between: [crank2/B, coupler2]}\n"
         "  C: {type: revolute, between: [coupler1/C, coupler2/C]}\n"
         "drivers:\n"
         "  trace: {inverse_kinematics: {frame: coupler1/C, path: {" +
         path + "}, joints: [A1, A2]}}\n";
}

TEST(PathFollower, DrivesSlidesAlongAPathOfThePlatform) {
  Assembled rpr(slides(circle));
  const std::vector<TimeValue> s = rpr.at(0.1);
  // Distances of the pins of each leg in closed form, with their derivatives (three legs of 0.4 m and 0.11 m).
  const double length[3] = {0.32847656654555, 0.30684632651013, 0.24303781085314};
  const double rate[3] = {-0.387493732240115, 0.577271860001917, -0.205116803595752};
  const double acceleration[3] = {-5.47062336173958, -2.9168457966741, 8.91436559947633};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(s[i].value, length[i], 1e-13);
    EXPECT_NEAR(s[i].rate, rate[i], 1e-12);
    EXPECT_NEAR(s[i].acceleration, acceleration[i], 1e-11);
  }
}

TEST(PathFollower, FollowsAPathThatLeavesTheAngleOpen) {
  // Cranks at 1.9 and 1.1 rad put the end there (closed form), the first coupler at 0.631268700615397 rad.
  const double x = 0.0129624469494248, y = 0.259978898857173;
  Assembled bars(five_bar("x: 0.0129624469494248 + 0.02*sin(5*t), y: 0.259978898857173"));
  const std::vector<TimeValue> now = bars.at(0.0), later = bars.at(0.7);
  EXPECT_NEAR(now[0].value, 1.9, 1e-13);
  EXPECT_NEAR(now[1].value, 1.1, 1e-13);
  const double px = x + 0.02 * std::sin(3.5) + 0.1, distance = std::hypot(px, y);
  const double inner = std::acos((0.15 * 0.15 + distance * distance - 0.2 * 0.2) / (2.0 * 0.15 * distance));
  EXPECT_NEAR(later[0].value, std::atan2(y, px) + inner, 1e-12);
  PathPose pose;
  ASSERT_TRUE(bars.system.motions().path(0, 0.0, pose, bars.fault));
  EXPECT_NEAR(pose[2].value, 0.631268700615397, 1e-13);
  EXPECT_EQ(pose[0].rate, 0.1);
  EXPECT_NE(pose[2].rate, 0.0);
}

TEST(PathFollower, AgreesWithTheClosedFormOfALeg) {
  // A base that is welded to ground is not ground, so that the legs have no closed form.
  const std::string legs = mechanism("3-rrr");
  std::string welded = replaced(legs, "  platform:", "  base: {mass: 1, inertia: 1}\n  platform:");
  welded = replaced(replaced(welded, "ground/A", "base/A"),
                    "\ntemplates:", "\njoints: {weld: {type: fixed, between: [ground, base]}}\ntemplates:");
  // The branch is that of the start: cranks to the left of the line from A to C.
  welded = replaced(welded, "        mass: 0.311040", "        pose: {angle: $at + pi + 0.9}\n        mass: 0.311040");
  welded = replaced(welded, "        mass: 0.194400", "        pose: {angle: $at + pi - 0.9}\n        mass: 0.194400");
  Assembled closed(legs), general(welded);
  ASSERT_TRUE(general.system.motions().follows(0));
  ASSERT_FALSE(closed.system.motions().follows(0));
  for (const double t : {0.0, 0.013, 0.171, 0.333, 0.499}) {
    const std::vector<TimeValue> a = closed.at(t), b = general.at(t);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_NEAR(std::remainder(a[i].value - b[i].value, 2.0 * M_PI), 0.0, 1e-12);
      EXPECT_NEAR(a[i].rate, b[i].rate, 1e-12 * 10.0);                   // rates are of order 10
      EXPECT_NEAR(a[i].acceleration, b[i].acceleration, 1e-12 * 100.0);  // accelerations of order 100
    }
  }
}

TEST(PathFollower, DerivativesAreThoseOfTheValue) {
  Assembled bars(five_bar("x: 0.013 + 0.02*sin(5*t), y: 0.26 + 0.01*t^2"));
  const double h = 1e-5;
  for (const double t : {0.2, 0.55, 0.9}) {
    const std::vector<TimeValue> now = bars.at(t), before = bars.at(t - h), after = bars.at(t + h);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(now[i].rate, (after[i].value - before[i].value) / (2.0 * h), 1e-8);
      EXPECT_NEAR(now[i].acceleration, (after[i].rate - before[i].rate) / (2.0 * h), 1e-7);
    }
  }
}

TEST(PathFollower, DependsOnTimeAlone) {
  Assembled bars(five_bar("x: 0.013 + 0.02*sin(5*t), y: 0.26"));
  const std::vector<TimeValue> first = bars.at(0.37);
  for (const double t : {0.9, 0.01, 0.5}) bars.at(t);
  const std::vector<TimeValue> again = bars.at(0.37);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(first[i].value, again[i].value);
    EXPECT_EQ(first[i].rate, again[i].rate);
    EXPECT_EQ(first[i].acceleration, again[i].acceleration);
  }
}

TEST(PathFollower, KeepsItsBranchThroughManyTurns) {
  // The end of the first coupler runs a hundred times around a circle; every time the same place has the same cranks.
  Assembled bars(five_bar("x: 0.013 + 0.02*sin(200*pi*t), y: 0.25 + 0.02*cos(200*pi*t)"));
  const std::vector<TimeValue> first = bars.at(0.0);
  for (const double t : {0.01, 0.5, 0.99}) EXPECT_NEAR(bars.at(t)[0].value, first[0].value, 1e-11);
}

TEST(PathFollower, EndsWhereThePathLeavesTheWorkspaceLong) {
  // Both arms are stretched at a distance of 0.35 m from their pins: y = sqrt(0.35^2 - 0.1^2) = 0.335 m.
  Assembled bars(five_bar("x: 0, y: 0.26 + 0.1*t"));
  bars.at(0.7);
  std::vector<TimeValue> values(2);
  EXPECT_FALSE(bars.system.motions().evaluate(0.8, {values.data(), 2}, bars.fault));
  EXPECT_STREQ(bars.fault.id, "ik-unreachable");
  EXPECT_EQ(bars.fault.kinematics, 0);
  const test::ModelRun run(five_bar("x: 0, y: 0.26 + 0.1*t"));
  EXPECT_EQ(run.outcome().exit_code, 4);
  EXPECT_NEAR(run.outcome().time, (std::sqrt(0.35 * 0.35 - 0.01) - 0.26) / 0.1, 2e-3);
}

TEST(PathFollower, NamesWhatIsWrongWithAPath) {
  EXPECT_EQ(id_of(five_bar("x: 0, y: 0.5")), "ik-unreachable");
  EXPECT_EQ(id_of(five_bar("x: 0.01")), "ik-underdetermined");
  EXPECT_EQ(id_of(five_bar("x: 0.01, y: 0.26, angle: 0.6")), "ik-unreachable");
  EXPECT_EQ(id_of(slides("x: 0.01, y: 0")), "ik-underdetermined");
}

TEST(PathFollower, RunsOnItsPath) {
  const test::ModelRun run(slides(circle, "simulation: {end: 0.1 s, step: 0.5 ms}\n"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  // Forces of the ideal mechanism from its inverse dynamics.
  EXPECT_NEAR(run.last("driver.leg1.P.force"), -6.16170145591126, 1e-9);
  EXPECT_NEAR(run.last("driver.leg2.P.force"), -1.50291505355381, 1e-9);
  EXPECT_NEAR(run.last("driver.leg3.P.force"), 7.91053515395606, 1e-9);
  EXPECT_NEAR(run.last("driver.circle.ex"), 0.0, 1e-12);
}

}  // namespace
}  // namespace freeplay
