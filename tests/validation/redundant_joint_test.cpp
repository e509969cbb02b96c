#include "run_model.h"

namespace freeplay::test {
namespace {

constexpr const char* twice =
    "freeplay: 1\ngravity: [0, -9.81]\n"
    "bodies: {rod: {mass: 1, inertia: 1/12, com: [0.5, 0]}}\n"
    "joints:\n"
    "  one: {type: revolute, between: [ground, rod]}\n"
    "  two: {type: revolute, between: [ground, rod]}\n"
    "initial: {joints: {one: 0.3}}\n"
    "simulation: {end: 0.5, step: 1 ms}\n";

// Rod at rest at 0.3 rad, closed form: each pin takes half.
TEST(RedundantJoint, EachOfTwoEqualPinsTakesHalfTheLoad) {
  const ModelRun run(twice);
  for (const char* pin : {"joint.one", "joint.two"}) {
    EXPECT_NEAR(run.at(0, std::string(pin) + ".fx"), 1.038589249501, 1e-11);
    EXPECT_NEAR(run.at(0, std::string(pin) + ".fy"), 1.547523303326, 1e-11);
  }
  EXPECT_EQ(run.start().facts.actual.rank, 2);
  EXPECT_EQ(run.start().facts.actual.redundant, 2);
  EXPECT_EQ(run.start().facts.actual.dof, 1);
}

TEST(RedundantJoint, TheMotionIsThatOfOnePin) {
  const ModelRun both(twice);
  const ModelRun single(replaced(twice, "  two: {type: revolute, between: [ground, rod]}\n", ""));
  ASSERT_EQ(both.outcome().status, RunStatus::completed);
  EXPECT_EQ(both.outcome().rejected, 0);
  double worst = 0.0;
  for (std::size_t i = 0; i < both.rows(); ++i) {
    worst = std::max(worst, std::abs(both.at(i, "body.rod.angle") - single.at(i, "body.rod.angle")));
    // Halves at every instant, the whole equal to that of one pin.
    EXPECT_NEAR(both.at(i, "joint.one.fy"), 0.5 * single.at(i, "joint.one.fy"), 1e-8) << i;
    EXPECT_NEAR(both.at(i, "joint.one.fy"), both.at(i, "joint.two.fy"), 1e-10) << i;
  }
  record("angle_difference", worst);
  EXPECT_LE(worst, 1e-9);  // iterations end at 1e-10 of the model size
  EXPECT_LT(both.statistics().position_residual(), 1e-10);
}

// Rows that say the same leave no noise in the error, however little is allowed.
TEST(RedundantJoint, TakesTheStepsOfOnePinUnderATolerance) {
  for (const char* tolerance : {"1e-8", "1e-11", "1e-13"}) {
    const std::string text = replaced(twice, "step: 1 ms",
                                      "integrator: dopri5, step: {size: 1e-3, adaptive: true, "
                                      "tolerance: " +
                                          std::string(tolerance) + "}");
    const ModelRun both(text);
    const ModelRun single(replaced(text, "  two: {type: revolute, between: [ground, rod]}\n", ""));
    ASSERT_EQ(both.outcome().status, RunStatus::completed) << tolerance << ": " << both.outcome().reason;
    EXPECT_NEAR(static_cast<double>(both.outcome().steps), static_cast<double>(single.outcome().steps),
                1.0 + 0.02 * static_cast<double>(single.outcome().steps))
        << tolerance;
  }
}

// A slider-crank, a parallelogram with a crank too many, a plate on three parallel legs that a cylinder pushes, a
// four-bar whose axes are parallel three times too often.
constexpr const char* links = R"yaml(freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {b: [0.2, 0], c: [0.4, 0]}}
  one: {mass: 0.3, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  two: {mass: 0.3, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  three: {mass: 0.3, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  bar: {mass: 1, inertia: 0.02, com: [0.3, 0.02], frames: {b: [0.2, 0], c: [0.4, 0]}}
joints:
  pa: {type: revolute, between: [ground, one]}
  pb: {type: revolute, between: [ground/b, two]}
  pc: {type: revolute, between: [ground/c, three]}
  qa: {type: revolute, between: [one/tip, bar]}
  qb: {type: revolute, between: [two/tip, bar/b]}
  qc: {type: revolute, between: [three/tip, bar/c]}
drivers:
  motor: {joint: pa, kind: angle, value: "30 deg + 2*sin(5*t)"}
simulation: {end: 3, accuracy: 1 um, output: {interval: 0.01}}
)yaml";
constexpr const char* guided_twice = R"yaml(freeplay: 1
gravity: [0, -9.81]
bodies:
  crank: {mass: 0.3, inertia: 1e-4, com: [0.025, 0], frames: {tip: [0.05, 0]}}
  coupler: {mass: 0.21, inertia: 2.5e-4, com: [0.06, 0], frames: {tip: [0.12, 0]}}
  slider: {mass: 0.14, inertia: 1e-4}
joints:
  main: {type: revolute, between: [ground, crank]}
  crankpin: {type: revolute, between: [crank/tip, coupler]}
  wrist: {type: revolute, between: [coupler/tip, slider]}
  guide: {type: prismatic, between: [ground, slider]}
  again: {type: prismatic, between: [ground, slider]}
drivers:
  motor: {joint: main, kind: velocity, value: 30}
initial: {joints: {main: 20 deg}}
simulation: {end: 1, accuracy: 1 um, output: {interval: 0.01}}
)yaml";
constexpr const char* plate_on_legs = R"yaml(freeplay: 1
gravity: [0, -9.81]
bodies:
  ground: {frames: {b: [0.3, 0], c: [0.1, -0.05], d: [-0.4, 0.2]}}
  left: {mass: 0.5, inertia: 2e-3, com: [0, 0.1], frames: {tip: [0, 0.2]}}
  right: {mass: 0.5, inertia: 2e-3, com: [0, 0.1], frames: {tip: [0, 0.2]}}
  third: {mass: 0.5, inertia: 2e-3, com: [0, 0.1], frames: {tip: [0, 0.2]}}
  plate: {mass: 2, inertia: 0.05, com: [0.15, 0.05], frames: {b: [0.3, 0], c: [0.1, -0.05]}}
  barrel: {mass: 0.4, inertia: 1e-3}
  rod: {mass: 0.4, inertia: 1e-3, com: [-0.1, 0]}
joints:
  pa: {type: revolute, between: [ground, left]}
  pb: {type: revolute, between: [ground/b, right]}
  pc: {type: revolute, between: [ground/c, third]}
  qa: {type: revolute, between: [left/tip, plate]}
  qb: {type: revolute, between: [right/tip, plate/b]}
  qc: {type: revolute, between: [third/tip, plate/c]}
  trunnion: {type: revolute, between: [ground/d, barrel]}
  eye: {type: revolute, between: [plate, rod]}
  cylinder: {type: prismatic, between: [barrel, rod]}
drivers:
  hydraulics: {joint: cylinder, kind: position, value: "0.4 + 0.12*sin(3*t)"}
simulation: {end: 3, accuracy: 1 um, output: {interval: 0.01}}
)yaml";
constexpr const char* in_space = R"yaml(freeplay: 1
space: spatial
gravity: [0, -9.81, 0]
bodies:
  ground: {frames: {b: [0.3, 0, 0]}}
  crank: {mass: 0.3, inertia: [1e-4, 3e-4, 3e-4], com: [0.05, 0, 0], frames: {tip: [0.1, 0, 0]}}
  coupler: {mass: 0.5, inertia: [1e-4, 3e-3, 3e-3], com: [0.15, 0, 0], frames: {tip: [0.3, 0, 0]}}
  rocker: {mass: 0.4, inertia: [1e-4, 2e-3, 2e-3], com: [0.1, 0, 0], frames: {tip: [0.2, 0, 0]}}
joints:
  main: {type: revolute, between: [ground, crank]}
  left: {type: revolute, between: [crank/tip, coupler]}
  right: {type: revolute, between: [coupler/tip, rocker/tip]}
  back: {type: revolute, between: [ground/b, rocker]}
drivers:
  motor: {joint: main, kind: velocity, value: 20}
simulation: {end: 1, accuracy: 1 um, output: {interval: 0.01}}
)yaml";

/// The largest energy residual by the largest work.
double imbalance(const std::string& text) {
  const ModelRun run(text, {}, {"energy.work"});
  EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  double work = 0.0;
  for (std::size_t i = 0; i < run.rows(); ++i) work = std::max(work, std::abs(run.at(i, "energy.work")));
  return run.statistics().energy_residual() / work;
}

// However redundant rows share the load, the power of all motion that is prescribed is one and the same, also in stages
// of a step, where the loops are a little open and no row follows exactly from the others.
TEST(RedundantJoint, PrescribedMotionDoesTheWorkThatBodiesTakeUp) {
  const std::string links_at_joint = replaced(links, "joint: pa, kind: angle, value: \"30 deg + 2*sin(5*t)\"",
                                              "joint: qa, kind: angle, value: \"-30 deg - sin(5*t)\"");
  const std::string two_drivers =
      replaced(links, "simulation", "  other: {joint: pc, kind: angle, value: \"30 deg + 2*sin(5*t)\"}\nsimulation");
  for (const std::string& text : {std::string(links), links_at_joint, two_drivers, std::string(guided_twice),
                                  std::string(plate_on_legs), std::string(in_space)}) {
    for (const char* integrator : {"dopri5", "verner6", "verner7"}) {
      const double part =
          imbalance(replaced(text, "accuracy: 1 um", std::string("accuracy: 1 um, integrator: ") + integrator));
      EXPECT_LT(part, 1e-4) << integrator << "\n" << text;
    }
  }
}

}  // namespace
}  // namespace freeplay::test
